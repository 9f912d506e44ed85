// SPDX-License-Identifier: GPL-3.0-or-later
// A deforming triangle surface for collision: its box tree, its adjacency, and the position of each point during the
// step, x(t) = x + t u, t in [0, 1], with u the displacement of the free motion. Scene frame, m.
#pragma once
#include <algorithm>
#include <array>
#include <bit>
#include <cstdint>
#include <span>
#include <tuple>
#include <vector>

#include "core/collision/search/aabb_tree.h"
#include "core/collision/shapes/closest.h"

namespace insula {

/// The surface point nearest to some point p.
struct NearestPoint {
  int triangle = -1;  ///< -1: none within the limit
  Vec3 bary = Vec3::Zero(), point = Vec3::Zero();
  double distance = 0;
  bool behind = false;           ///< p is behind the surface
  Vec3 outward = Vec3::UnitZ();  ///< unit, along the line through p and the point, out of the surface
};

/// Largest displacement of the vertices of each region of a mesh, since the last update and in the free motion, m.
struct RegionMotion {
  std::array<double, 64> moved{}, may_move{};
};

class CollisionMesh {
 public:
  /// Triangles are counter-clockwise seen from outside. Closed surfaces and open sheets (one-sided, facing along their
  /// normals) are allowed.
  void build(std::span<const Vec3> rest, std::span<const std::array<int, 3>> triangles);
  /// Adjacency of a few triangles, without a box tree or regions: for normals, locally_closest() and nearest() alone.
  /// The arrays of positions must exist until the next call. Does not allocate up to the numbers of reserve_few().
  /// weighted_normals: as weighted_normal() returns them from then on; empty: as the triangles say.
  void build_few(std::span<const Vec3> positions, std::span<const std::array<int, 3>> triangles,
                 std::span<const Vec3> weighted_normals = {});
  void reserve_few(std::size_t vertices, std::size_t triangles);
  void move_few(std::span<const Vec3> positions) { positions_ = positions; }  ///< of as many vertices
  /// Takes this step's positions and free displacements (empty: a fixed surface) and refits the tree. The arrays must
  /// exist until the next update.
  void update(std::span<const Vec3> positions, std::span<const Vec3> free);
  /// The same with motion that has already been measured since the last update.
  void update(std::span<const Vec3> positions, std::span<const Vec3> free, const RegionMotion& motion);
  /// Call it before positions are changed by anything but the step. The next update then measures from the present
  /// positions.
  void keep_positions();

  /// Sum over all updates of the largest displacement of a vertex, m. Between two updates no vertex moved farther than
  /// the difference.
  double travelled() const { return travelled_; }
  double farthest_free() const { return farthest_free_; }  ///< of all vertices in this step, m

  /// Vertices are divided into regions of neighbours, the bits of a mask. Motion in one region then does not affect the
  /// others.
  static constexpr int regions = std::tuple_size_v<decltype(RegionMotion::moved)>;
  std::uint64_t region_of(int v) const { return std::uint64_t(1) << region_of_[std::size_t(v)]; }
  std::uint64_t regions_of(int tri) const {
    const auto& t = triangle(tri);
    return region_of(t[0]) | region_of(t[1]) | region_of(t[2]);
  }
  /// Regions that may come within a distance of the box in this step, m. Lowers `other` to the distance of the nearest
  /// region that is not in `known`.
  std::uint64_t regions_near(const Aabb& box, double within, std::uint64_t known, double& other) const {
    return tree_.marks_near(box, within, known, other);
  }
  double moved(std::uint64_t mask) const { return most(motion_.moved, mask); }        ///< largest in the last update, m
  double may_move(std::uint64_t mask) const { return most(motion_.may_move, mask); }  ///< largest free displacement, m
  long updates() const { return updates_; }

  const AabbTree& tree() const { return tree_; }
  int vertex_count() const { return int(positions_.size()); }
  int triangle_count() const { return int(triangles_.size()); }
  const std::array<int, 3>& triangle(int i) const { return triangles_[std::size_t(i)]; }
  /// The triangle at a position of the tree's order.
  const std::array<int, 3>& triangle_at(int place) const { return in_order_[std::size_t(place)]; }
  std::span<const int> triangles_around(int v) const {
    const int first = ring_start_[std::size_t(v)];
    return {ring_.data() + first, std::size_t(ring_start_[std::size_t(v) + 1] - first)};
  }

  Vec3 vertex(int v, double t = 0) const {
    const Vec3& x = positions_[std::size_t(v)];
    return free_.empty() || t == 0 ? x : Vec3(x + t * free_[std::size_t(v)]);
  }
  Vec3 free(int v) const { return free_.empty() ? Vec3(Vec3::Zero()) : free_[std::size_t(v)]; }
  Vec3 point(int tri, const Vec3& bary, double t = 0) const {
    const auto& v = triangle(tri);
    return bary[0] * vertex(v[0], t) + bary[1] * vertex(v[1], t) + bary[2] * vertex(v[2], t);
  }
  Vec3 free_at(int tri, const Vec3& bary) const {
    const auto& v = triangle(tri);
    return bary[0] * free(v[0]) + bary[1] * free(v[1]) + bary[2] * free(v[2]);
  }
  Vec3 face_normal(int tri, double t = 0) const;  ///< unit
  Vec3 vertex_normal(int v, double t = 0) const;  ///< unit, weighted by angle
  /// vertex_normal() times the square root of a weight: 1 where the surface is smooth, 0 at a sharp corner, whose
  /// triangles are more than 42 degrees from it.
  Vec3 weighted_normal(int v, double t = 0) const;
  Vec3 rough_normal(int v) const;  ///< unit, weighted by area, at the start of the step
  /// Outward unit normal of the feature: of a face, the mean of an edge's faces, or angle-weighted at a vertex. Let c
  /// be the surface point closest to p. The product of the normal with p - c has the sign of the distance of p
  /// (Baerentzen, Aanaes 2005).
  Vec3 pseudo_normal(int tri, const TriangleFeature& f, double t = 0) const;
  /// Neighbour across the edge that starts at that corner; -1 at a border.
  int across(int tri, int corner) const { return across_[std::size_t(tri)][std::size_t(corner)]; }
  /// Whether c is also closest on the neighbouring triangles. c is the point of this triangle that is closest to
  /// something in direction d (unit, from c). No step from c into a neighbour may lead along d by more than `slack` (a
  /// sine).
  bool locally_closest(int tri, const TriangleFeature& f, const Vec3& d, double t, double slack) const;
  /// Nearest point of the surface at time t, if it is no farther than `limit`. With `side`, only triangles that face
  /// that side count.
  NearestPoint nearest(const Vec3& p, double t, double limit, const Vec3* side = nullptr) const;

 private:
  AabbTree tree_;
  std::vector<std::array<int, 3>> triangles_;
  std::vector<std::array<int, 3>> in_order_;  ///< triangles in the tree's order: neighbours are close in memory
  std::vector<std::array<int, 3>> across_;    ///< neighbour across the edge that starts at each corner, -1 at a border
  std::vector<int> ring_start_, ring_;        ///< triangles around each vertex
  std::vector<Vec3> last_;                    ///< positions of the last update; empty: the caller measures motion
  double travelled_ = 0, farthest_free_ = 0;
  void take(std::span<const Vec3> positions, std::span<const Vec3> free, const RegionMotion& motion);
  using PerRegion = std::array<double, regions>;
  static double most(const PerRegion& of, std::uint64_t mask) {
    double m = 0;
    for (; mask != 0; mask &= mask - 1) m = std::max(m, of[std::size_t(std::countr_zero(mask))]);
    return m;
  }
  std::vector<int> region_of_;                 ///< of the vertices
  std::vector<int> region_start_, in_region_;  ///< vertices of the regions
  RegionMotion motion_;
  PerRegion room_{};  ///< how far each region's vertices may move before one leaves its boxes in the tree, m
  long updates_ = 0;
  std::span<const Vec3> positions_, free_, weighted_normals_;
};

}  // namespace insula
