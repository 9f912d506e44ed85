// SPDX-License-Identifier: GPL-3.0-or-later
// GJK with the closest point of each simplex found by checking its faces, which also holds for flat simplices.
#include "core/collision/shapes/gjk.h"

#include <array>

#include "core/collision/shapes/closest.h"

namespace insula {
namespace {

struct Simplex {
  int n = 0;
  Vec3 w[4];  // a - b
  int ia[4], ib[4];
  double l[4];  // weights of the closest point

  void keep(const int* which, const double* weight, int count) {
    Simplex s;
    for (int k = 0; k < count; ++k) {
      if (!(weight[k] > 0)) continue;
      s.w[s.n] = w[which[k]];
      s.ia[s.n] = ia[which[k]];
      s.ib[s.n] = ib[which[k]];
      s.l[s.n] = weight[k];
      ++s.n;
    }
    *this = s;
  }
  bool has(int of_a, int of_b) const {
    bool known = false;
    for (int k = 0; k < n; ++k) known = known || (ia[k] == of_a && ib[k] == of_b);
    return known;
  }
  void add(const Vec3& difference, int of_a, int of_b) {
    w[n] = difference;
    ia[n] = of_a;
    ib[n] = of_b;
    ++n;
  }
  Vec3 point() const {
    Vec3 v = Vec3::Zero();
    for (int k = 0; k < n; ++k) v += l[k] * w[k];
    return v;
  }
};

// Reduces the simplex to the face that holds the point closest to the origin; false if the origin is inside.
bool reduce(Simplex& s) {
  if (s.n == 1) {
    s.l[0] = 1;
    return true;
  }
  if (s.n == 2) {
    const double t = closest_on_segment(Vec3::Zero(), s.w[0], s.w[1]);
    const int which[2] = {0, 1};
    const double weight[2] = {1 - t, t};
    s.keep(which, weight, 2);
    return true;
  }
  if (s.n == 3) {
    const Vec3 b = closest_on_triangle(Vec3::Zero(), s.w[0], s.w[1], s.w[2]);
    const int which[3] = {0, 1, 2};
    s.keep(which, b.data(), 3);
    return true;
  }
  static constexpr int faces[4][4] = {{0, 1, 2, 3}, {0, 1, 3, 2}, {0, 2, 3, 1}, {1, 2, 3, 0}};
  double least = -1;
  int best = -1;
  Vec3 bary = Vec3::Zero();
  for (int f = 0; f < 4; ++f) {
    const Vec3 &a = s.w[faces[f][0]], &b = s.w[faces[f][1]], &c = s.w[faces[f][2]], &d = s.w[faces[f][3]];
    const Vec3 n = (b - a).cross(c - a);
    if (n.dot(-a) * n.dot(d - a) > 0) continue;  // the origin lies on d's side of this face
    const Vec3 l = closest_on_triangle(Vec3::Zero(), a, b, c);
    const double d2 = (l[0] * a + l[1] * b + l[2] * c).squaredNorm();
    if (best < 0 || d2 < least) {
      least = d2;
      best = f;
      bary = l;
    }
  }
  if (best < 0) return false;
  s.keep(faces[best], bary.data(), 3);
  return true;
}

// Support points along v: the vertices of the two hulls that are farthest in the direction of the other hull.
std::array<int, 2> support(std::span<const Vec3> a, std::span<const Vec3> b, const Vec3& v) {
  int ia = 0, ib = 0;
  double low = v.dot(a[0]), high = v.dot(b[0]);
  for (int i = 1; i < int(a.size()); ++i)
    if (const double d = v.dot(a[i]); d < low) {
      low = d;
      ia = i;
    }
  for (int i = 1; i < int(b.size()); ++i)
    if (const double d = v.dot(b[i]); d > high) {
      high = d;
      ib = i;
    }
  return {ia, ib};
}

HullDistance closest_points(const Simplex& s, std::span<const Vec3> a, std::span<const Vec3> b) {
  HullDistance r;
  for (int k = 0; k < s.n; ++k) {
    r.a += s.l[k] * a[s.ia[k]];
    r.b += s.l[k] * b[s.ib[k]];
    r.index[k] = s.ib[k];
    r.weight[k] = s.l[k];
  }
  r.count = s.n;
  return r;
}

}  // namespace

HullDistance hull_distance(std::span<const Vec3> a, std::span<const Vec3> b, double limit) {
  Simplex s;
  s.n = 1;
  s.ia[0] = s.ib[0] = 0;
  s.w[0] = a[0] - b[0];
  s.l[0] = 1;
  Vec3 v = s.w[0];
  bool meet = false;
  double apart = 0;  // lower bound of the distance, from a plane perpendicular to v
  for (int iteration = 0; iteration < 64; ++iteration) {
    const double vv = v.squaredNorm();
    if (vv < 1e-24) {  // a picometre
      meet = true;
      break;
    }
    const auto [ia, ib] = support(a, b, v);
    const Vec3 w = a[ia] - b[ib];
    const double along = v.dot(w);
    if (vv - along <= 1e-13 * vv) break;
    if (along > 0 && along * along > limit * limit * vv) {
      apart = along / std::sqrt(vv);
      break;
    }
    if (s.has(ia, ib)) break;
    const Simplex before = s;
    s.add(w, ia, ib);
    if (!reduce(s)) {
      meet = true;
      s = before;
      break;
    }
    const Vec3 next = s.point();
    if (!(next.squaredNorm() < vv)) {  // rounding: no further progress
      s = before;
      break;
    }
    v = next;
  }
  HullDistance r = closest_points(s, a, b);
  r.distance = meet ? 0 : apart > 0 ? apart : v.norm();
  return r;
}

}  // namespace insula
