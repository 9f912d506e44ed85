// SPDX-License-Identifier: GPL-3.0-or-later
// Four triangles beside each other, and the distance of a point from each. It is computed without a branch, in single
// precision, to select those that need an exact test. Coordinates are relative to a centre no more than a few cm away.
#pragma once
#include <array>

#include "core/collision/search/aabb_tree.h"

namespace insula {

struct FourTriangles {
  std::array<Float4, 3> a, b, c;  ///< corners, x y z, m

  /// Squared distances of a point, m2.
  Float4 distance2(float x, float y, float z) const {
    const V p{Float4{} + x, Float4{} + y, Float4{} + z};
    const V ab = b - V(a), bc = c - V(b), ca = a - V(c), ap = p - V(a), bp = p - V(b), cp = p - V(c);
    const Float4 to_edges = least(least(to_edge(ab, ap), to_edge(bc, bp)), to_edge(ca, cp));
    const V n = cross(ab, bc);
    const Float4 h = dot(n, ap), nn = dot(n, n);
    const auto over =
        (dot(cross(n, ab), ap) >= 0) & (dot(cross(n, bc), bp) >= 0) & (dot(cross(n, ca), cp) >= 0) & (nn > 0);
    const Float4 plane = h * h / (nn > 0 ? nn : Float4{} + 1);
    // The normal of a sliver is mostly rounding error, so its edges are used too.
    return over ? least(plane, to_edges) : to_edges;
  }
  /// Whether the exact squared distance may be at most limit2. The error of distance2() is at most 0.02 % and 0.3 um.
  static bool may_be_within(float distance2, double limit2) { return double(distance2) <= limit2 * 1.001 + 1e-13; }

 private:
  struct V : std::array<Float4, 3> {
    V(const std::array<Float4, 3>& o) : std::array<Float4, 3>(o) {}
    V(Float4 x, Float4 y, Float4 z) : std::array<Float4, 3>{x, y, z} {}
  };
  friend V operator-(const std::array<Float4, 3>& p, const V& q) { return {p[0] - q[0], p[1] - q[1], p[2] - q[2]}; }
  static Float4 least(Float4 p, Float4 q) { return p < q ? p : q; }
  static Float4 dot(const V& p, const V& q) { return p[0] * q[0] + p[1] * q[1] + p[2] * q[2]; }
  static V cross(const V& p, const V& q) {
    return {p[1] * q[2] - p[2] * q[1], p[2] * q[0] - p[0] * q[2], p[0] * q[1] - p[1] * q[0]};
  }
  static Float4 to_edge(const V& edge, const V& from) {
    constexpr Float4 one{1, 1, 1, 1};
    const Float4 s = dot(edge, from) / (dot(edge, edge) + 1e-30f);
    const Float4 t = s > 0 ? (s < 1 ? s : one) : Float4{};
    const V d{from[0] - t * edge[0], from[1] - t * edge[1], from[2] - t * edge[2]};
    return dot(d, d);
  }
};

}  // namespace insula
