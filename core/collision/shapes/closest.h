// SPDX-License-Identifier: GPL-3.0-or-later
// Closest points of points, segments and triangles. Exact up to rounding, also for degenerate triangles and segments.
// Any length unit. Results are in barycentric coordinates of the triangle's corners (sum 1, none negative).
// Source: C. Ericson, Real-Time Collision Detection (2005), 5.1.5, 5.1.9 and 5.1.10, with degenerate cases added.
#pragma once
#include <algorithm>

#include "core/base/math.h"

namespace insula {

/// A pair of closest points: p on the first shape, c on the triangle.
struct ClosestPair {
  Vec3 p = Vec3::Zero();
  Vec3 c = Vec3::Zero();
  Vec3 bary = Vec3::Zero();  ///< of c
  double distance2 = 0;      ///< squared; 0 when the shapes meet
};

/// Parameter in [0, 1] of the point of segment ab closest to p.
inline double closest_on_segment(const Vec3& p, const Vec3& a, const Vec3& b) {
  const Vec3 ab = b - a;
  const double d = ab.squaredNorm();
  if (!(d > 0)) return 0;
  return std::clamp((p - a).dot(ab) / d, 0.0, 1.0);
}

/// Parameters (s, t) in [0, 1] of the closest points of segments p0p1 and q0q1.
inline void closest_segments(const Vec3& p0, const Vec3& p1, const Vec3& q0, const Vec3& q1, double& s, double& t) {
  const Vec3 d1 = p1 - p0, d2 = q1 - q0, r = p0 - q0;
  const double a = d1.squaredNorm(), e = d2.squaredNorm();
  if (!(a > 0)) {
    s = 0;
    t = closest_on_segment(p0, q0, q1);
    return;
  }
  if (!(e > 0)) {
    t = 0;
    s = closest_on_segment(q0, p0, p1);
    return;
  }
  const double b = d1.dot(d2), c = d1.dot(r), f = d2.dot(r);
  const double denom = a * e - b * b;
  // Parallel to rounding: any s serves, the clamps below do the rest.
  s = denom > 1e-14 * a * e ? std::clamp((b * f - c * e) / denom, 0.0, 1.0) : 0.0;
  t = (b * s + f) / e;
  if (t < 0) {
    t = 0;
    s = std::clamp(-c / a, 0.0, 1.0);
  } else if (t > 1) {
    t = 1;
    s = std::clamp((b - c) / a, 0.0, 1.0);
  }
}

/// Barycentric coordinates of the point of triangle abc closest to p.
inline Vec3 closest_on_triangle(const Vec3& p, const Vec3& a, const Vec3& b, const Vec3& c) {
  const Vec3 ab = b - a, ac = c - a, ap = p - a;
  const double area2 = ab.cross(ac).squaredNorm();
  if (!(area2 > 1e-24 * ab.squaredNorm() * ac.squaredNorm())) {
    // No area: the best of the three sides.
    const Vec3* v[3] = {&a, &b, &c};
    Vec3 best(1, 0, 0);
    double least = ap.squaredNorm();
    for (int k = 0; k < 3; ++k) {
      const Vec3 &u = *v[k], &w = *v[(k + 1) % 3];
      const double s = closest_on_segment(p, u, w);
      const double d = (p - u - s * (w - u)).squaredNorm();
      if (d < least) {
        least = d;
        best.setZero();
        best[k] = 1 - s;
        best[(k + 1) % 3] = s;
      }
    }
    return best;
  }
  const double d1 = ab.dot(ap), d2 = ac.dot(ap);
  if (d1 <= 0 && d2 <= 0) return {1, 0, 0};
  const Vec3 bp = p - b;
  const double d3 = ab.dot(bp), d4 = ac.dot(bp);
  if (d3 >= 0 && d4 <= d3) return {0, 1, 0};
  const double vc = d1 * d4 - d3 * d2;
  if (vc <= 0 && d1 >= 0 && d3 <= 0) {
    const double v = d1 / (d1 - d3);
    return {1 - v, v, 0};
  }
  const Vec3 cp = p - c;
  const double d5 = ab.dot(cp), d6 = ac.dot(cp);
  if (d6 >= 0 && d5 <= d6) return {0, 0, 1};
  const double vb = d5 * d2 - d1 * d6;
  if (vb <= 0 && d2 >= 0 && d6 <= 0) {
    const double w = d2 / (d2 - d6);
    return {1 - w, 0, w};
  }
  const double va = d3 * d6 - d5 * d4;
  if (va <= 0 && d4 - d3 >= 0 && d5 - d6 >= 0) {
    const double w = (d4 - d3) / ((d4 - d3) + (d5 - d6));
    return {0, 1 - w, w};
  }
  const double i = 1.0 / (va + vb + vc);
  const double v = vb * i, w = vc * i;
  return {1 - v - w, v, w};
}

inline ClosestPair point_triangle(const Vec3& p, const Vec3& a, const Vec3& b, const Vec3& c) {
  ClosestPair r;
  r.p = p;
  r.bary = closest_on_triangle(p, a, b, c);
  r.c = r.bary[0] * a + r.bary[1] * b + r.bary[2] * c;
  r.distance2 = (p - r.c).squaredNorm();
  return r;
}

/// Segment p0p1 against triangle abc. Where they meet, p = c is the meeting point and the distance is exactly 0.
inline ClosestPair segment_triangle(const Vec3& p0, const Vec3& p1, const Vec3& a, const Vec3& b, const Vec3& c) {
  const Vec3 n = (b - a).cross(c - a);
  const double h0 = n.dot(p0 - a), h1 = n.dot(p1 - a);
  if ((h0 <= 0 && h1 >= 0) || (h0 >= 0 && h1 <= 0)) {
    if (h0 != h1) {
      const Vec3 x = p0 + (h0 / (h0 - h1)) * (p1 - p0);
      const double nn = n.squaredNorm();
      const double u = n.dot((c - b).cross(x - b)), v = n.dot((a - c).cross(x - c)), w = n.dot((b - a).cross(x - a));
      if (u >= 0 && v >= 0 && w >= 0 && nn > 0) {
        ClosestPair r;
        r.bary = Vec3(u, v, w) / (u + v + w);
        r.p = r.c = x;
        return r;
      }
    }
  }
  ClosestPair best = point_triangle(p0, a, b, c);
  const ClosestPair end = point_triangle(p1, a, b, c);
  if (end.distance2 < best.distance2) best = end;
  const Vec3* v[3] = {&a, &b, &c};
  for (int k = 0; k < 3; ++k) {
    const Vec3 &q0 = *v[k], &q1 = *v[(k + 1) % 3];
    double s, t;
    closest_segments(p0, p1, q0, q1, s, t);
    const Vec3 x = p0 + s * (p1 - p0), y = q0 + t * (q1 - q0);
    const double d = (x - y).squaredNorm();
    if (d < best.distance2) {
      best.distance2 = d;
      best.p = x;
      best.c = y;
      best.bary.setZero();
      best.bary[k] = 1 - t;
      best.bary[(k + 1) % 3] = t;
    }
  }
  return best;
}

/// Which part of a triangle a point lies on, from its barycentric coordinates.
enum class FeatureKind { face, edge, vertex };
struct TriangleFeature {
  FeatureKind kind = FeatureKind::face;
  int corner = 0;  ///< vertex: its corner; edge: the corner it starts at (it ends at the next one)
};
inline TriangleFeature feature_of(const Vec3& bary) {
  constexpr double zero = 1e-9;
  const bool a = bary[0] <= zero, b = bary[1] <= zero, c = bary[2] <= zero;
  if (!a && !b && !c) return {FeatureKind::face, 0};
  if (b && c) return {FeatureKind::vertex, 0};
  if (a && c) return {FeatureKind::vertex, 1};
  if (a && b) return {FeatureKind::vertex, 2};
  if (c) return {FeatureKind::edge, 0};
  if (a) return {FeatureKind::edge, 1};
  return {FeatureKind::edge, 2};
}

}  // namespace insula
