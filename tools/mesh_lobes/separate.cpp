// SPDX-License-Identifier: GPL-3.0-or-later
// Gaps between parts, dihedral improvement, clearance and embedding figures.
#include "separate.h"

#include <CGAL/AABB_tree.h>
#include <CGAL/version.h>
#if CGAL_VERSION_NR >= 1060000000
#include <CGAL/AABB_traits_3.h>
#include <CGAL/AABB_triangle_primitive_3.h>
#else
#include <CGAL/AABB_traits.h>
#include <CGAL/AABB_triangle_primitive.h>
#endif
#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>

#include <algorithm>
#include <cstdint>
#include <limits>
#include <map>

namespace insula::mesh_tool {
namespace {

using Kernel = CGAL::Exact_predicates_inexact_constructions_kernel;
using Point = Kernel::Point_3;
using Triangles = std::vector<Kernel::Triangle_3>;
#if CGAL_VERSION_NR >= 1060000000
using Primitive = CGAL::AABB_triangle_primitive_3<Kernel, Triangles::const_iterator>;
using Tree = CGAL::AABB_tree<CGAL::AABB_traits_3<Kernel, Primitive>>;
#else
using Primitive = CGAL::AABB_triangle_primitive<Kernel, Triangles::const_iterator>;
using Tree = CGAL::AABB_tree<CGAL::AABB_traits<Kernel, Primitive>>;
#endif

std::size_t at(int i) { return static_cast<std::size_t>(i); }
Point to_point(const Vec3& v) { return {v[0], v[1], v[2]}; }

// Distance to a set of closed surfaces, negative inside (parity of crossings along a ray in general position).
class SignedDistance {
 public:
  void add(const TriangleMesh& mesh) {
    for (const Triangle& t : mesh.triangles)
      triangles_.emplace_back(to_point(mesh.points[at(t[0])]), to_point(mesh.points[at(t[1])]),
                              to_point(mesh.points[at(t[2])]));
  }
  void build() {
    tree_.rebuild(triangles_.cbegin(), triangles_.cend());
    tree_.accelerate_distance_queries();
  }
  // The nearest point of the surfaces and the number of its triangle, in the order of adding.
  std::pair<Vec3, std::size_t> nearest(const Vec3& p) const {
    const auto [q, triangle] = tree_.closest_point_and_primitive(to_point(p));
    return {{q.x(), q.y(), q.z()}, static_cast<std::size_t>(triangle - triangles_.cbegin())};
  }
  double distance(const Vec3& p) const { return std::sqrt(tree_.squared_distance(to_point(p))); }
  bool inside(const Vec3& p) const {
    const Kernel::Ray_3 ray(to_point(p), Kernel::Vector_3(0.7123, 0.2917, 0.6389));
    return tree_.number_of_intersected_primitives(ray) % 2 == 1;
  }
  double operator()(const Vec3& p) const {
    const double d = distance(p);
    return inside(p) ? -d : d;
  }
  bool crosses(const Kernel::Triangle_3& t) const { return tree_.do_intersect(t); }
  const Triangles& triangles() const { return triangles_; }

 private:
  Triangles triangles_;
  Tree tree_;
};

std::vector<Vec3> vertex_normals(std::size_t count, const std::vector<Vec3>& points,
                                 const std::vector<Triangle>& triangles) {
  std::vector<Vec3> normals(count, Vec3{});
  for (const Triangle& t : triangles) {
    const Vec3 area = cross(points[at(t[1])] - points[at(t[0])], points[at(t[2])] - points[at(t[0])]);
    for (const int v : t) normals[at(v)] = normals[at(v)] + area;
  }
  for (Vec3& n : normals)
    if (const double length = norm(n); length > 0) n = (1 / length) * n;
  return normals;
}

double min_angle(const TetMesh& mesh, const Tet& t) {
  return dihedral_range(mesh.points[at(t[0])], mesh.points[at(t[1])], mesh.points[at(t[2])], mesh.points[at(t[3])])
      .min_deg;
}

// A small counter-based generator: the same sequence everywhere.
struct Sequence {
  std::uint64_t state = 0x9e3779b97f4a7c15ull;
  double next() {  // in (-1, 1)
    state ^= state << 13, state ^= state >> 7, state ^= state << 17;
    return static_cast<double>(state >> 11) * 0x1.0p-52 - 1.0;
  }
};

}  // namespace

TriangleMesh boundary_mesh(const TetMesh& mesh) { return {mesh.points, boundary_triangles(mesh)}; }

namespace {

std::vector<std::size_t> tets_below(const TetMesh& mesh, double angle_deg) {
  std::vector<std::size_t> bad;
  for (std::size_t i = 0; i < mesh.tets.size(); ++i)
    if (min_angle(mesh, mesh.tets[i]) < angle_deg) bad.push_back(i);
  return bad;
}

/// Moves points at random and keeps each move that increases the smallest angle around the point. Points of the
/// boundary only move inward.
class PointMover {
 public:
  PointMover(TetMesh& mesh, const std::vector<Triangle>& border, double boundary_shift)
      : mesh_(mesh),
        boundary_shift_(boundary_shift),
        start_(mesh.points),
        star_(mesh.points.size()),
        normals_(vertex_normals(mesh.points.size(), mesh.points, border)),
        on_border_(mesh.points.size(), 0) {
    for (std::size_t i = 0; i < mesh.tets.size(); ++i)
      for (const int v : mesh.tets[i]) star_[at(v)].push_back(i);
    for (const Triangle& t : border)
      for (const int v : t) on_border_[at(v)] = 1;
  }
  /// Tries to increase the angles of a tetrahedron.
  void mend(std::size_t tet) {
    for (const int v : mesh_.tets[tet]) {
      double size = 1e30;
      for (const int w : mesh_.tets[tet])
        if (w != v) size = std::min(size, norm(mesh_.points[at(w)] - mesh_.points[at(v)]));
      double best = star_angle(v);
      for (int trial = 0; trial < 24; ++trial) best = try_move(v, size * 0.4 / (1 + trial % 6), best);
    }
  }

 private:
  double star_angle(int v) const {
    double least = 180;
    for (const std::size_t i : star_[at(v)]) least = std::min(least, min_angle(mesh_, mesh_.tets[i]));
    return least;
  }
  /// Tries one random move of v. Returns the smallest angle around v afterwards, which is at least `best`.
  double try_move(int v, double scale, double best) {
    const Vec3 old = mesh_.points[at(v)];
    Vec3 move{};
    for (double& c : move) c = scale * sequence_.next();
    if (on_border_[at(v)]) {
      const double outward = dot(move, normals_[at(v)]);
      if (outward > 0) move = move - outward * normals_[at(v)];
      if (norm(old + move - start_[at(v)]) > boundary_shift_) return best;
    }
    mesh_.points[at(v)] = old + move;
    const double angle = star_angle(v);
    if (angle > best) return angle;
    mesh_.points[at(v)] = old;
    return best;
  }

  TetMesh& mesh_;
  double boundary_shift_;
  std::vector<Vec3> start_;
  std::vector<std::vector<std::size_t>> star_;
  std::vector<Vec3> normals_;
  std::vector<char> on_border_;
  Sequence sequence_;
};

/// Removes one tetrahedron at the boundary whose angles are too small. False if none can be removed.
bool remove_one(TetMesh& mesh, double angle_deg, std::size_t border_size) {
  for (const std::size_t i : tets_below(mesh, angle_deg)) {
    TetMesh trial = mesh;
    trial.tets.erase(trial.tets.begin() + static_cast<std::ptrdiff_t>(i));
    if (boundary_triangles(trial).size() > border_size + 8 || !is_closed(boundary_triangles(trial))) continue;
    if (boundary_triangles(trial).size() > boundary_triangles(mesh).size() + 1) continue;  // an interior cell
    mesh = std::move(trial);
    return true;
  }
  return false;
}

}  // namespace

double improve_dihedral(TetMesh& mesh, double target_deg, double boundary_shift) {
  const auto border = boundary_triangles(mesh);
  PointMover mover(mesh, border, boundary_shift);
  for (int round = 0; round < 60; ++round) {
    const std::vector<std::size_t> bad = tets_below(mesh, target_deg);
    if (bad.empty()) break;
    for (const std::size_t i : bad) mover.mend(i);
  }
  // What cannot be mended may be taken away at the boundary.
  for (int round = 0; round < 20; ++round)
    if (!remove_one(mesh, std::min(target_deg, 10.5), border.size())) break;
  drop_unused_points(mesh);
  return dihedral_range(mesh).min_deg;
}

double separate_parts(std::vector<TetMesh>& parts, double gap, int rounds) {
  if (parts.size() < 2) return std::numeric_limits<double>::infinity();
  double least = -1;
  for (int round = 0; round <= rounds; ++round) {
    least = std::numeric_limits<double>::infinity();
    std::vector<TriangleMesh> borders;
    for (const TetMesh& part : parts) borders.push_back(boundary_mesh(part));
    std::vector<std::vector<Vec3>> moved;
    for (std::size_t a = 0; a < parts.size(); ++a) {
      SignedDistance others;
      for (std::size_t b = 0; b < parts.size(); ++b)
        if (b != a) others.add(borders[b]);
      others.build();
      const auto& points = parts[a].points;
      std::vector<double> push(points.size(), 0);
      const auto normals = vertex_normals(points.size(), points, borders[a].triangles);
      for (const Triangle& t : borders[a].triangles) {
        constexpr int n = 4;  // 15 samples a triangle; a sample pushes the corners that carry a quarter of it or more
        for (int i = 0; i <= n; ++i)
          for (int j = 0; i + j <= n; ++j) {
            const int share[3] = {i, j, n - i - j};
            Vec3 p{};
            for (std::size_t c = 0; c < 3; ++c) p = p + (static_cast<double>(share[c]) / n) * points[at(t[c])];
            double d = others.distance(p);
            if (d > std::max(gap, 6.0)) continue;  // nothing is that deep inside another part
            if (others.inside(p)) d = -d;
            least = std::min(least, d);
            if (d < gap)
              for (std::size_t c = 0; c < 3; ++c)
                if (share[c]) push[at(t[c])] = std::max(push[at(t[c])], 0.55 * (gap - d) + 0.005);
          }
      }
      std::vector<Vec3> next = points;
      for (std::size_t v = 0; v < next.size(); ++v)
        if (push[v] > 0) next[v] = next[v] - std::min(push[v], 0.4) * normals[v];
      moved.push_back(std::move(next));
    }
    if (least >= 0.98 * gap || round == rounds) break;
    for (std::size_t a = 0; a < parts.size(); ++a) parts[a].points = std::move(moved[a]);
  }
  return least;
}

void reach_out(TetMesh& mesh, const std::vector<Vec3>& points, double allowed, int rounds) {
  for (int round = 0; round < rounds; ++round) {
    const TriangleMesh border = boundary_mesh(mesh);
    SignedDistance surface;
    surface.add(border);
    surface.build();
    std::vector<Vec3> pull(mesh.points.size(), Vec3{});
    bool any = false;
    for (const Vec3& p : points) {
      if (surface.distance(p) <= allowed || surface.inside(p)) continue;
      const auto [q, triangle] = surface.nearest(p);
      const Vec3 move = p - q;
      // The nearest corner follows: the other two would drag the facet over its neighbours.
      const Triangle& t = border.triangles[triangle];
      int corner = t[0];
      for (const int v : t)
        if (norm(mesh.points[at(v)] - q) < norm(mesh.points[at(corner)] - q)) corner = v;
      if (norm(move) > norm(pull[at(corner)])) pull[at(corner)] = move;
      any = true;
    }
    if (!any) break;
    const std::vector<Vec3> old = mesh.points;
    for (std::size_t v = 0; v < pull.size(); ++v) {
      const double length = norm(pull[v]);
      if (length > 0) mesh.points[v] = mesh.points[v] + (std::min(0.5 * length, 0.8) / length) * pull[v];
    }
    // A vertex that would flatten a tetrahedron goes back.
    for (const Tet& t : mesh.tets)
      if (min_angle(mesh, t) < 8)
        for (const int v : t) mesh.points[at(v)] = old[at(v)];
  }
}

Clearance clearance(const TriangleMesh& a, const TriangleMesh& b) {
  SignedDistance to_a, to_b;
  to_a.add(a), to_a.build();
  to_b.add(b), to_b.build();
  Clearance out;
  out.distance = std::numeric_limits<double>::infinity();
  for (const auto& t : to_a.triangles()) out.intersect = out.intersect || to_b.crosses(t);
  const auto scan = [&](const TriangleMesh& mesh, const SignedDistance& other) {
    for (const Triangle& t : mesh.triangles) {
      const Vec3 &p = mesh.points[at(t[0])], &q = mesh.points[at(t[1])], &r = mesh.points[at(t[2])];
      constexpr int n = 4;  // 15 samples a triangle
      for (int i = 0; i <= n; ++i)
        for (int j = 0; i + j <= n; ++j)
          out.distance = std::min(out.distance,
                                  other.distance((1.0 / n) * (double(i) * p + double(j) * q + double(n - i - j) * r)));
    }
    if (!mesh.triangles.empty() && other.inside(mesh.points[at(mesh.triangles[0][0])])) out.intersect = true;
  };
  scan(a, to_b);
  scan(b, to_a);
  return out;
}

Embedding embedding(const TriangleMesh& surface, const TetMesh& volume) {
  SignedDistance border;
  border.add(boundary_mesh(volume));
  border.build();
  Embedding out;
  std::size_t outside = 0;
  for (const Vec3& p : surface.points)
    if (!border.inside(p)) {
      ++outside;
      out.furthest = std::max(out.furthest, border.distance(p));
    }
  out.share_outside =
      surface.points.empty() ? 0 : static_cast<double>(outside) / static_cast<double>(surface.points.size());
  return out;
}

}  // namespace insula::mesh_tool
