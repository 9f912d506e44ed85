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
constexpr double min_area_share = 0.003;    // of the whole surface
constexpr double min_roundness = 0.5;       // 4 pi area / perimeter^2: 1 for a circle, 0.5 for an ellipse of 1 to 3.6
constexpr double rim_width = 0.35;          // times the cap's radius: within it the surface must have turned away
constexpr int sectors = 8, min_turned = 7;  // in all directions but one ...
constexpr double max_cosine = 0.7;          // ... by 45 degrees on average

}  // namespace

Surface with_flat_caps(const TriMesh& m) {
  const std::size_t n = m.triangles.size();
  std::map<std::pair<int, int>, int> left;  // triangle to the left of a directed edge
  std::vector<Vec3> normal(n);
  std::vector<double> area(n);
  double whole = 0;
  for (std::size_t t = 0; t < n; ++t) {
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

  struct Found {
    std::vector<int> triangles;
    CapPlane plane;
  };
  std::vector<std::array<int, 3>> beside(n);
  for (std::size_t t = 0; t < n; ++t)
    for (std::size_t k = 0; k < 3; ++k) beside[t][k] = left.at({m.triangles[t][(k + 1) % 3], m.triangles[t][k]});
  const auto across = [&](std::size_t t, std::size_t k) { return std::size_t(beside[t][k]); };
  const auto middle = [&](std::size_t t) -> Vec3 {
    const auto& tri = m.triangles[t];
    return (m.vertices[std::size_t(tri[0])] + m.vertices[std::size_t(tri[1])] + m.vertices[std::size_t(tri[2])]) / 3;
  };
  std::vector<char> taken(n);
  std::vector<int> mark(n, -1), ring_mark(n, -1);
  int marks = 0;
  const auto grow = [&](std::size_t seed, const Vec3& towards) {
    Found cap;
    cap.triangles = {int(seed)};
    mark[seed] = ++marks;
    Vec3 sum = Vec3::Zero(), centre = Vec3::Zero();
    double total = 0;
    for (std::size_t i = 0; i < cap.triangles.size(); ++i) {
      const auto t = std::size_t(cap.triangles[i]);
      total += area[t], sum += area[t] * normal[t], centre += area[t] * middle(t);
      for (std::size_t k = 0; k < 3; ++k) {
        const std::size_t next = across(t, k);
        if (mark[next] == marks || taken[next] ||
            normal[next].dot(towards) < std::cos(flat_deg * std::numbers::pi / 180))
          continue;
        mark[next] = marks;
        cap.triangles.push_back(int(next));
      }
    }
    cap.plane = {"", centre / total, sum.normalized(), std::sqrt(total / std::numbers::pi)};
    return cap;
  };

  std::vector<std::pair<double, int>> seeds;  // the flattest places first
  for (std::size_t t = 0; t < n; ++t) {
    double bend = 0;
    for (std::size_t k = 0; k < 3; ++k) bend = std::max(bend, 1 - normal[t].dot(normal[across(t, k)]));
    seeds.emplace_back(bend, int(t));
  }
  std::sort(seeds.begin(), seeds.end());
  std::vector<Found> found;
  std::vector<char> refused(n);
  for (const auto& [bend, first] : seeds) {
    const auto seed = std::size_t(first);
    if (taken[seed] || refused[seed]) continue;
    Found cap = grow(seed, normal[seed]);
    const auto large = [&] { return std::numbers::pi * cap.plane.radius * cap.plane.radius >= min_area_share * whole; };
    if (large()) cap = grow(seed, cap.plane.normal);
    const double r = cap.plane.radius, total = std::numbers::pi * r * r;
    // The ring of triangles about it, each with the place on the rim it was reached from.
    double rim = 0, ring_area[sectors] = {}, ring_cosine[sectors] = {};
    const Vec3 e1 = cap.plane.normal.unitOrthogonal(), e2 = cap.plane.normal.cross(e1);
    std::vector<std::pair<int, Vec3>> ring;
    const auto reach = [&](std::size_t t, const Vec3& from) {
      if (mark[t] == marks || ring_mark[t] == marks || (middle(t) - from).norm() > rim_width * r) return;
      ring_mark[t] = marks;
      ring.emplace_back(int(t), from);
    };
    if (large())
      for (const int t : cap.triangles)
        for (std::size_t k = 0; k < 3; ++k) {
          const Vec3 &a = m.vertices[std::size_t(m.triangles[std::size_t(t)][k])],
                     &b = m.vertices[std::size_t(m.triangles[std::size_t(t)][(k + 1) % 3])];
          if (mark[across(std::size_t(t), k)] == marks) continue;
          rim += (b - a).norm();
          reach(across(std::size_t(t), k), 0.5 * (a + b));
        }
    for (std::size_t i = 0; i < ring.size(); ++i) {
      const auto [t, from] = ring[i];
      const Vec3 d = middle(std::size_t(t)) - cap.plane.centre;
      const int sector =
          std::clamp(int((std::atan2(d.dot(e2), d.dot(e1)) / std::numbers::pi + 1) / 2 * sectors), 0, sectors - 1);
      ring_area[sector] += area[std::size_t(t)],
          ring_cosine[sector] += area[std::size_t(t)] * normal[std::size_t(t)].dot(cap.plane.normal);
      for (std::size_t k = 0; k < 3; ++k) reach(across(std::size_t(t), k), from);
    }
    int turned = 0;
    for (int i = 0; i < sectors; ++i) turned += ring_cosine[i] < max_cosine * ring_area[i];
    const bool good = large() && turned >= min_turned && 4 * std::numbers::pi * total > min_roundness * rim * rim;
    if (!good) {
      refused[seed] = 1;
      continue;
    }
    for (const int t : cap.triangles) taken[std::size_t(t)] = 1;
    found.push_back(std::move(cap));
  }
  std::stable_sort(found.begin(), found.end(),
                   [](const Found& a, const Found& b) { return a.plane.radius > b.plane.radius; });
  Surface out{m, std::vector<int>(n, -1), {}};
  for (const Found& f : found) {
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
