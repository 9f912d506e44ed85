// SPDX-License-Identifier: GPL-3.0-or-later
// Small meshes and reproducible random numbers for the tests of collision.
#pragma once
#include <cmath>
#include <map>
#include <numbers>
#include <random>
#include <utility>

#include "core/collision/search/collision_mesh.h"
#include "core/model/mesh.h"

namespace insula::shapes {

/// Axis-aligned box. Each side has n x n squares of two triangles, which face outward.
inline TriMesh box(const Vec3& low, const Vec3& high, int n) {
  TriMesh m;
  std::map<std::array<int, 3>, int> number;
  const auto vertex = [&](const std::array<int, 3>& g) {
    const auto [at, fresh] = number.emplace(g, int(m.vertices.size()));
    if (fresh) {
      Vec3 p;
      for (int k = 0; k < 3; ++k) p[k] = low[k] + (high[k] - low[k]) * g[std::size_t(k)] / n;
      m.vertices.push_back(p);
    }
    return at->second;
  };
  for (int axis = 0; axis < 3; ++axis)
    for (int side = 0; side < 2; ++side)
      for (int i = 0; i < n; ++i)
        for (int j = 0; j < n; ++j) {
          const auto at = [&](int a, int b) {
            std::array<int, 3> g{};
            g[std::size_t(axis)] = side * n;
            g[std::size_t((axis + 1) % 3)] = a;
            g[std::size_t((axis + 2) % 3)] = b;
            return vertex(g);
          };
          const int a = at(i, j), b = at(i + 1, j), c = at(i + 1, j + 1), d = at(i, j + 1);
          if (side == 1) {
            m.triangles.push_back({a, b, c});
            m.triangles.push_back({a, c, d});
          } else {
            m.triangles.push_back({a, c, b});
            m.triangles.push_back({a, d, c});
          }
        }
  return m;
}

/// Two shapes as one surface.
inline TriMesh joined(TriMesh a, const TriMesh& b) {
  const int offset = int(a.vertices.size());
  a.vertices.insert(a.vertices.end(), b.vertices.begin(), b.vertices.end());
  for (auto t : b.triangles) a.triangles.push_back({t[0] + offset, t[1] + offset, t[2] + offset});
  return a;
}

/// Sphere from a subdivided octahedron: 8 * 4^level triangles.
inline TriMesh sphere(const Vec3& centre, double radius, int level) {
  TriMesh m;
  m.vertices = {Vec3::UnitX(), -Vec3::UnitX(), Vec3::UnitY(), -Vec3::UnitY(), Vec3::UnitZ(), -Vec3::UnitZ()};
  m.triangles = {{0, 2, 4}, {2, 1, 4}, {1, 3, 4}, {3, 0, 4}, {2, 0, 5}, {1, 2, 5}, {3, 1, 5}, {0, 3, 5}};
  for (int l = 0; l < level; ++l) {
    std::map<std::pair<int, int>, int> middle;
    const auto mid = [&](int a, int b) {
      const auto [at, fresh] = middle.emplace(std::minmax(a, b), int(m.vertices.size()));
      if (fresh) m.vertices.push_back((m.vertices[std::size_t(a)] + m.vertices[std::size_t(b)]).normalized());
      return at->second;
    };
    std::vector<std::array<int, 3>> next;
    for (const auto& t : m.triangles) {
      const int a = mid(t[0], t[1]), b = mid(t[1], t[2]), c = mid(t[2], t[0]);
      next.insert(next.end(), {{t[0], a, c}, {a, t[1], b}, {c, b, t[2]}, {a, b, c}});
    }
    m.triangles = next;
  }
  for (Vec3& v : m.vertices) v = centre + radius * v;
  return m;
}

/// A tube about z, open at its ends, of so many rings with a distance of `apart`. Each ring has `sides` vertices and is
/// turned by `stagger` of a side against the last one.
inline TriMesh tube(double radius, int sides, int rings, double apart, double stagger) {
  TriMesh m;
  for (int r = 0; r < rings; ++r)
    for (int i = 0; i < sides; ++i) {
      const double a = 2 * std::numbers::pi * (i + stagger * r) / sides;
      m.vertices.emplace_back(radius * std::cos(a), radius * std::sin(a), apart * (r - rings / 2));
    }
  const auto at = [&](int r, int i) { return r * sides + i % sides; };
  for (int r = 0; r + 1 < rings; ++r)
    for (int i = 0; i < sides; ++i) {
      m.triangles.push_back({at(r, i), at(r, i + 1), at(r + 1, i)});
      m.triangles.push_back({at(r, i + 1), at(r + 1, i + 1), at(r + 1, i)});
    }
  return m;
}

/// A surface at rest.
struct Still {
  TriMesh shape;
  CollisionMesh mesh;
  explicit Still(TriMesh s) : shape(std::move(s)) {
    mesh.build(shape.vertices, shape.triangles);
    mesh.update(shape.vertices, {});
  }
};

class Random {
 public:
  explicit Random(unsigned seed) : engine_(seed) {}
  double between(double low, double high) { return low + (high - low) * (double(engine_()) / 4294967296.0); }
  Vec3 in_box(double half) {
    const double x = between(-half, half), y = between(-half, half), z = between(-half, half);
    return {x, y, z};
  }
  Vec3 direction() {
    for (;;) {
      const Vec3 d = in_box(1);
      if (d.norm() > 0.1 && d.norm() < 1) return d.normalized();
    }
  }

 private:
  std::mt19937 engine_;
};

}  // namespace insula::shapes
