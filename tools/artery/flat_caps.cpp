// SPDX-License-Identifier: GPL-3.0-or-later
// Finds the flat caps that close the openings of a real surface.
#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>

#include "core/model/geometry/triangle_distance.h"
#include "import_parts.h"

namespace insula::artery {
namespace {

constexpr double flat_deg = 20;             // what a label volume's smoothed surface needs
constexpr double alike_deg = 5;             // seeds that face so nearly the same way grow into the same patch
constexpr double min_area_share = 0.0015;   // of the whole surface
constexpr double min_roundness = 0.5;       // 4 pi area / perimeter^2: 1 for a circle, 0.5 for an ellipse of 1 to 3.6
constexpr double rim_width = 0.35;          // times the cap's radius: within it the surface must have turned away
constexpr int sectors = 8, min_turned = 7;  // the surface bends away in all sectors but one
constexpr double depth_behind = 0.6, least_behind = 0.7, most_behind = 1.6;  // in radii and diameters of a cap
constexpr double max_cosine = 0.7;  // cosine of 45 degrees, the smallest mean angle of a sector

/// Triangles of a closed surface: areas, normals, neighbours.
struct Facets {
  const TriMesh& m;
  std::vector<Vec3> normal;
  std::vector<double> area;
  std::vector<std::array<int, 3>> beside;  ///< neighbour across the edge from corner k to the next
  double whole = 0;                        ///< area of the surface

  explicit Facets(const TriMesh& mesh)
      : m(mesh), normal(mesh.triangles.size()), area(mesh.triangles.size()), beside(mesh.triangles.size()) {
    std::map<std::pair<int, int>, int> left;  // triangle to the left of a directed edge
    for (std::size_t t = 0; t < normal.size(); ++t) {
      const auto& tri = m.triangles[t];
      const Vec3 &a = m.vertices[std::size_t(tri[0])], &b = m.vertices[std::size_t(tri[1])],
                 &c = m.vertices[std::size_t(tri[2])];
      const Vec3 twice = (b - a).cross(c - a);
      area[t] = 0.5 * twice.norm(), normal[t] = twice.normalized(), whole += area[t];
      for (std::size_t k = 0; k < 3; ++k)
        if (!left.emplace(std::pair(tri[k], tri[(k + 1) % 3]), int(t)).second)
          throw std::runtime_error("the surface is no manifold");
    }
    for (const auto& [edge, t] : left)
      if (!left.count({edge.second, edge.first})) throw std::runtime_error("the surface is not closed");
    for (std::size_t t = 0; t < beside.size(); ++t)
      for (std::size_t k = 0; k < 3; ++k) beside[t][k] = left.at({m.triangles[t][(k + 1) % 3], m.triangles[t][k]});
  }
  std::size_t count() const { return area.size(); }
  std::size_t across(std::size_t t, std::size_t k) const { return std::size_t(beside[t][k]); }
  Vec3 middle(std::size_t t) const {
    const auto& tri = m.triangles[t];
    return (m.vertices[std::size_t(tri[0])] + m.vertices[std::size_t(tri[1])] + m.vertices[std::size_t(tri[2])]) / 3;
  }
  /// All triangles, those in the flattest regions first.
  std::vector<std::size_t> flattest_first() const {
    std::vector<std::pair<double, int>> seeds;
    for (std::size_t t = 0; t < count(); ++t) {
      double bend = 0;
      for (std::size_t k = 0; k < 3; ++k) bend = std::max(bend, 1 - normal[t].dot(normal[across(t, k)]));
      seeds.emplace_back(bend, int(t));
    }
    std::sort(seeds.begin(), seeds.end());
    std::vector<std::size_t> out;
    for (const auto& [bend, t] : seeds) out.push_back(std::size_t(t));
    return out;
  }
};

struct FlatCap {
  std::vector<int> triangles;
  CapPlane plane;
};

/// Grows flat patches and decides which of them are caps.
class CapFinder {
 public:
  explicit CapFinder(const Facets& f)
      : f_(f), taken_(f.count()), refused_(f.count()), mark_(f.count(), -1), ring_mark_(f.count(), -1) {}

  std::vector<FlatCap> find() {
    std::vector<FlatCap> found;
    for (const std::size_t seed : f_.flattest_first()) {
      if (taken_[seed] || refused_[seed]) continue;
      FlatCap cap = grow(seed, f_.normal[seed]);
      if (!large(cap)) continue;
      cap = grow(seed, cap.plane.normal);
      if (!large(cap) || !surface_turns_away(cap)) {
        refuse_alike(cap, f_.normal[seed]);
        continue;
      }
      for (const int t : cap.triangles) taken_[std::size_t(t)] = 1;
      found.push_back(std::move(cap));
    }
    return found;
  }

 private:
  /// On a large smooth dome every triangle would else grow its patch.
  void refuse_alike(const FlatCap& cap, const Vec3& normal) {
    const double alike = std::cos(alike_deg * std::numbers::pi / 180);
    for (const int t : cap.triangles)
      if (f_.normal[std::size_t(t)].dot(normal) > alike) refused_[std::size_t(t)] = 1;
  }

  /// The triangles that are connected with the seed and face `towards`.
  FlatCap grow(std::size_t seed, const Vec3& towards) {
    FlatCap cap;
    cap.triangles = {int(seed)};
    mark_[seed] = ++marks_;
    Vec3 sum = Vec3::Zero(), centre = Vec3::Zero();
    double total = 0;
    for (std::size_t i = 0; i < cap.triangles.size(); ++i) {
      const auto t = std::size_t(cap.triangles[i]);
      total += f_.area[t], sum += f_.area[t] * f_.normal[t], centre += f_.area[t] * f_.middle(t);
      for (std::size_t k = 0; k < 3; ++k) {
        const std::size_t next = f_.across(t, k);
        if (mark_[next] == marks_ || taken_[next] ||
            f_.normal[next].dot(towards) < std::cos(flat_deg * std::numbers::pi / 180))
          continue;
        mark_[next] = marks_;
        cap.triangles.push_back(int(next));
      }
    }
    cap.plane = {"", centre / total, sum.normalized(), std::sqrt(total / std::numbers::pi)};
    return cap;
  }

  bool large(const FlatCap& cap) const {
    return std::numbers::pi * cap.plane.radius * cap.plane.radius >= min_area_share * f_.whole;
  }

  /// Adds a triangle to the ring around the cap that was grown last. `from` is the point of the rim from which it was
  /// reached.
  void reach(std::size_t t, const Vec3& from, double radius) {
    if (mark_[t] == marks_ || ring_mark_[t] == marks_ || (f_.middle(t) - from).norm() > rim_width * radius) return;
    ring_mark_[t] = marks_;
    ring_.emplace_back(int(t), from);
  }

  /// Adds the first triangles of the ring. Returns the length of the rim.
  double begin_ring(const FlatCap& cap) {
    ring_.clear();
    double rim = 0;
    for (const int t : cap.triangles)
      for (std::size_t k = 0; k < 3; ++k) {
        const auto& tri = f_.m.triangles[std::size_t(t)];
        const Vec3 &a = f_.m.vertices[std::size_t(tri[k])], &b = f_.m.vertices[std::size_t(tri[(k + 1) % 3])];
        if (mark_[f_.across(std::size_t(t), k)] == marks_) continue;
        rim += (b - a).norm();
        reach(f_.across(std::size_t(t), k), 0.5 * (a + b), cap.plane.radius);
      }
    return rim;
  }

  /// Whether the cap that was grown last is round, and the surface bends away from it in nearly all directions.
  bool surface_turns_away(const FlatCap& cap) {
    const double rim = begin_ring(cap);
    double ring_area[sectors] = {}, ring_cosine[sectors] = {};
    const Vec3 e1 = cap.plane.normal.unitOrthogonal(), e2 = cap.plane.normal.cross(e1);
    for (std::size_t i = 0; i < ring_.size(); ++i) {
      const auto [t, from] = ring_[i];
      const Vec3 d = f_.middle(std::size_t(t)) - cap.plane.centre;
      const int sector =
          std::clamp(int((std::atan2(d.dot(e2), d.dot(e1)) / std::numbers::pi + 1) / 2 * sectors), 0, sectors - 1);
      ring_area[sector] += f_.area[std::size_t(t)],
          ring_cosine[sector] += f_.area[std::size_t(t)] * f_.normal[std::size_t(t)].dot(cap.plane.normal);
      for (std::size_t k = 0; k < 3; ++k) reach(f_.across(std::size_t(t), k), from, cap.plane.radius);
    }
    int turned = 0;
    for (int i = 0; i < sectors; ++i) turned += ring_cosine[i] < max_cosine * ring_area[i];
    const double total = std::numbers::pi * cap.plane.radius * cap.plane.radius;
    return turned >= min_turned && 4 * std::numbers::pi * total > min_roundness * rim * rim;
  }

  const Facets& f_;
  std::vector<char> taken_, refused_;
  std::vector<int> mark_, ring_mark_;  ///< of each triangle: the last patch that has it in the patch or its ring
  int marks_ = 0;
  std::vector<std::pair<int, Vec3>> ring_;
};

/// Whether the vessel goes on behind the cap as wide as the cap is. A flat place on the side of a vessel or a dome, as
/// voxels leave it, has a far wider section behind it.
bool ends_a_vessel(const TriMesh& m, const CapPlane& cap) {
  const double behind = section_diameter(m, cap.centre - depth_behind * cap.radius * cap.normal, cap.normal,
                                         most_behind * 2 * cap.radius);
  return behind > least_behind * 2 * cap.radius && behind < most_behind * 2 * cap.radius;
}

}  // namespace

Surface with_flat_caps(const TriMesh& m) {
  const Facets facets(m);
  std::vector<FlatCap> found = CapFinder(facets).find();
  std::erase_if(found, [&](const FlatCap& cap) { return !ends_a_vessel(m, cap.plane); });
  std::stable_sort(found.begin(), found.end(),
                   [](const FlatCap& a, const FlatCap& b) { return a.plane.radius > b.plane.radius; });
  Surface out{m, std::vector<int>(m.triangles.size(), -1), {}};
  for (const FlatCap& f : found) {
    for (const int t : f.triangles) out.patch[std::size_t(t)] = int(out.caps.size());
    out.caps.push_back(f.plane);
  }
  return out;
}

WallPoints::WallPoints(const Surface& s) {
  std::vector<Box> boxes;
  for (std::size_t t = 0; t < s.patch.size(); ++t) {
    if (s.patch[t] >= 0) continue;
    auto& tri = triangles_.emplace_back();
    Box box;
    for (std::size_t k = 0; k < 3; ++k)
      tri[k] = s.mesh.vertices[std::size_t(s.mesh.triangles[t][k])], box.extend(tri[k]);
    boxes.push_back(box);
  }
  if (boxes.empty()) throw std::runtime_error("the surface has no wall");
  tree_ = std::make_unique<BoxTree>(std::move(boxes));
}

Vec3 WallPoints::nearest(const Vec3& p) const {
  const auto on = [&](int i) {
    const auto& t = triangles_[std::size_t(i)];
    return nearest_on_triangle(p, t[0], t[1], t[2]);
  };
  return on(tree_->nearest(p, [&](int i) { return (on(i) - p).squaredNorm(); }));
}

}  // namespace insula::artery
