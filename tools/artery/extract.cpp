// SPDX-License-Identifier: GPL-3.0-or-later
// Marching tetrahedra over a grid whose cubes are cut into six tetrahedra (Kuhn), then cutting by planes.
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <map>
#include <stdexcept>

#include "surface.h"

namespace insula::artery {
namespace {

struct Grid {
  Vec3 low;
  double step;
  std::array<std::int64_t, 3> n;
  std::int64_t index(std::int64_t i, std::int64_t j, std::int64_t k) const { return (k * n[1] + j) * n[0] + i; }
  Vec3 point(std::int64_t v) const {
    return low + step * Vec3(double(v % n[0]), double(v / n[0] % n[1]), double(v / (n[0] * n[1])));
  }
};

Grid grid_of(const NodeValues& nodes) { return {nodes.low, nodes.step, {nodes.size[0], nodes.size[1], nodes.size[2]}}; }

}  // namespace

TriMesh extract(const std::function<double(const Vec3&)>& value, const Vec3& low, const Vec3& high, double step) {
  NodeValues nodes{low, step, {}, {}};
  for (int a = 0; a < 3; ++a) nodes.size[std::size_t(a)] = int(std::ceil((high[a] - low[a]) / step)) + 1;
  const Grid grid = grid_of(nodes);
  nodes.value.resize(std::size_t(grid.n[0] * grid.n[1] * grid.n[2]));
  for (std::size_t v = 0; v < nodes.value.size(); ++v) nodes.value[v] = value(grid.point(std::int64_t(v)));
  return extract(std::move(nodes));
}

TriMesh extract(NodeValues nodes) {
  const Grid grid = grid_of(nodes);
  std::vector<double>& f = nodes.value;
  for (double& v : f)
    if (v == 0) v = 1e-12;
  TriMesh out;
  std::map<std::pair<std::int64_t, std::int64_t>, int> made;
  const auto crossing = [&](std::int64_t a, std::int64_t b) {
    if (a > b) std::swap(a, b);
    const auto [at, fresh] = made.emplace(std::pair(a, b), int(out.vertices.size()));
    if (fresh) {
      const double w = std::clamp(f[std::size_t(a)] / (f[std::size_t(a)] - f[std::size_t(b)]), 0.02, 0.98);
      out.vertices.push_back((1 - w) * grid.point(a) + w * grid.point(b));
    }
    return at->second;
  };
  static constexpr int paths[6][3] = {{0, 1, 2}, {0, 2, 1}, {1, 0, 2}, {1, 2, 0}, {2, 0, 1}, {2, 1, 0}};
  for (std::int64_t k = 0; k + 1 < grid.n[2]; ++k)
    for (std::int64_t j = 0; j + 1 < grid.n[1]; ++j)
      for (std::int64_t i = 0; i + 1 < grid.n[0]; ++i)
        for (const auto& path : paths) {
          std::array<std::int64_t, 4> t;
          std::array<std::int64_t, 3> c{i, j, k};
          t[0] = grid.index(c[0], c[1], c[2]);
          for (std::size_t s = 0; s < 3; ++s) {
            ++c[std::size_t(path[s])];
            t[s + 1] = grid.index(c[0], c[1], c[2]);
          }
          std::vector<std::int64_t> in, outside;
          for (const auto v : t) (f[std::size_t(v)] < 0 ? in : outside).push_back(v);
          if (in.empty() || outside.empty()) continue;
          const auto add = [&](int a, int b, int d) {  // oriented from inside to outside
            const Vec3 normal = (out.vertices[std::size_t(b)] - out.vertices[std::size_t(a)])
                                    .cross(out.vertices[std::size_t(d)] - out.vertices[std::size_t(a)]);
            if (normal.dot(grid.point(outside[0]) - grid.point(in[0])) < 0) std::swap(b, d);
            out.triangles.push_back({a, b, d});
          };
          if (in.size() == 1) {
            add(crossing(in[0], outside[0]), crossing(in[0], outside[1]), crossing(in[0], outside[2]));
          } else if (in.size() == 3) {
            add(crossing(in[0], outside[0]), crossing(in[1], outside[0]), crossing(in[2], outside[0]));
          } else {
            const int a = crossing(in[0], outside[0]), b = crossing(in[0], outside[1]),
                      c2 = crossing(in[1], outside[1]), d = crossing(in[1], outside[0]);
            add(a, b, c2);
            add(a, c2, d);
          }
        }
  return out;
}

namespace {

/// Cuts a surface at a cap's plane, near the cap.
class CutSurface {
 public:
  CutSurface(Surface& surface, const CapPlane& cap, double reach)
      : surface_(surface), m_(surface.mesh), cap_(cap), over_(m_.vertices.size()), near_(m_.vertices.size()) {
    for (std::size_t v = 0; v < over_.size(); ++v) {
      over_[v] = (m_.vertices[v] - cap.centre).dot(cap.normal);
      if (std::abs(over_[v]) < 1e-9) over_[v] = 1e-9;
      near_[v] = (m_.vertices[v] - cap.centre).norm() < reach;
    }
  }

  void cut() {
    for (std::size_t t = 0; t < m_.triangles.size(); ++t) {
      int beyond = 0;
      bool all_near = true;
      for (const int v : m_.triangles[t])
        beyond += over_[std::size_t(v)] > 0, all_near = all_near && near_[std::size_t(v)];
      if (beyond == 0 || !all_near) keep(m_.triangles[t], surface_.patch[t]);
      else if (beyond < 3) split(t);
    }
    if (rim_.empty()) throw std::runtime_error("the plane of " + cap_.name + " meets no vessel");
  }

  /// Closes the rim with a fan of triangles around its centre.
  void close() {
    const int label = int(surface_.caps.size());
    Vec3 centre = Vec3::Zero();
    for (const auto& [a, b] : rim_) centre += m_.vertices[std::size_t(a)] / double(rim_.size());
    const int hub = int(m_.vertices.size());
    m_.vertices.push_back(centre);
    std::size_t count = 0;
    for (int v = rim_.begin()->first; count < rim_.size(); ++count) {
      const auto at = rim_.find(v);
      if (at == rim_.end()) throw std::runtime_error("the rim of " + cap_.name + " is not closed");
      keep({v, at->second, hub}, label);
      v = at->second;
      if (v == rim_.begin()->first) break;
    }
    if (count + 1 != rim_.size()) throw std::runtime_error("the plane of " + cap_.name + " cuts more than one vessel");
    m_.triangles = std::move(kept_);
    surface_.patch = std::move(patch_);
    surface_.caps.push_back(cap_);
  }

 private:
  void keep(const std::array<int, 3>& t, int patch) { kept_.push_back(t), patch_.push_back(patch); }
  int crossing(int a, int b) {
    const auto [at, fresh] = made_.emplace(std::minmax(a, b), int(m_.vertices.size()));
    if (fresh) {
      const double w = over_[std::size_t(a)] / (over_[std::size_t(a)] - over_[std::size_t(b)]);
      m_.vertices.push_back((1 - w) * m_.vertices[std::size_t(a)] + w * m_.vertices[std::size_t(b)]);
    }
    return at->second;
  }
  void split(std::size_t t) {
    const auto tri = m_.triangles[t];
    std::vector<int> polygon, rim;
    for (std::size_t k = 0; k < 3; ++k) {
      const int a = tri[k], b = tri[(k + 1) % 3];
      if (over_[std::size_t(a)] < 0) polygon.push_back(a);
      if ((over_[std::size_t(a)] < 0) != (over_[std::size_t(b)] < 0)) {
        const int x = crossing(a, b);
        polygon.push_back(x);
        if (over_[std::size_t(a)] < 0) rim.insert(rim.begin(), x);
        else rim.push_back(x);
      }
    }
    for (std::size_t k = 1; k + 1 < polygon.size(); ++k)
      keep({polygon[0], polygon[k], polygon[k + 1]}, surface_.patch[t]);
    rim_[rim[1]] = rim[0];  // the wall's edge is rim[0] -> rim[1]
  }

  Surface& surface_;
  TriMesh& m_;
  const CapPlane& cap_;
  std::vector<double> over_;  ///< signed height of each vertex over the plane
  std::vector<char> near_;    ///< of each vertex: whether it is near the cap
  std::map<std::pair<int, int>, int> made_;
  std::vector<std::array<int, 3>> kept_;
  std::vector<int> patch_;
  std::map<int, int> rim_;  ///< edges of the rim, opposite to the wall's direction
};

}  // namespace

void cut_and_close(Surface& surface, const CapPlane& cap, double reach) {
  CutSurface cut(surface, cap, reach);
  cut.cut();
  cut.close();
  number_by_use(surface.mesh);
}

void number_by_use(TriMesh& mesh) {
  std::vector<int> renumber(mesh.vertices.size(), -1);
  std::vector<Vec3> vertices;
  for (auto& t : mesh.triangles)
    for (int& v : t) {
      int& to = renumber[std::size_t(v)];
      if (to < 0) to = int(vertices.size()), vertices.push_back(mesh.vertices[std::size_t(v)]);
      v = to;
    }
  mesh.vertices = std::move(vertices);
}

}  // namespace insula::artery
