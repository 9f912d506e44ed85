// SPDX-License-Identifier: GPL-3.0-or-later
// Neighbour grid, shortest paths (Dijkstra) and normals.
#include "plugins/strand_springs/nearest.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <queue>

namespace insula {

NearestVertices::NearestVertices(const std::vector<Vec3>& vertices, double cell) : vertices_(vertices), cell_(cell) {
  if (vertices.empty()) return;
  Vec3 high = low_ = vertices.front();
  for (const Vec3& v : vertices) {
    low_ = low_.cwiseMin(v);
    high = high.cwiseMax(v);
  }
  // A grid of more than a million cubes has no advantage.
  cell_ = std::max(cell, (high - low_).maxCoeff() / 100);
  for (int k = 0; k < 3; ++k) n_[k] = int((high[k] - low_[k]) / cell_) + 1;
  std::vector<int> of(vertices.size());
  start_.assign(std::size_t(n_[0]) * std::size_t(n_[1]) * std::size_t(n_[2]) + 1, 0);
  for (std::size_t i = 0; i < vertices.size(); ++i) {
    int c[3];
    for (int k = 0; k < 3; ++k) c[k] = std::clamp(int((vertices[i][k] - low_[k]) / cell_), 0, n_[k] - 1);
    of[i] = (c[2] * n_[1] + c[1]) * n_[0] + c[0];
    ++start_[std::size_t(of[i]) + 1];
  }
  for (std::size_t i = 1; i < start_.size(); ++i) start_[i] += start_[i - 1];
  index_.resize(vertices.size());
  std::vector<int> at(start_.begin(), start_.end() - 1);
  for (std::size_t i = 0; i < vertices.size(); ++i) index_[std::size_t(at[std::size_t(of[i])]++)] = int(i);
}

void NearestVertices::within(const Vec3& p, double r, std::vector<int>& out) const {
  out.clear();
  if (vertices_.empty()) return;
  int lo[3], hi[3];
  for (int k = 0; k < 3; ++k) {
    lo[k] = std::clamp(int(std::floor((p[k] - r - low_[k]) / cell_)), 0, n_[k] - 1);
    hi[k] = std::clamp(int(std::floor((p[k] + r - low_[k]) / cell_)), 0, n_[k] - 1);
  }
  for (int z = lo[2]; z <= hi[2]; ++z)
    for (int y = lo[1]; y <= hi[1]; ++y)
      for (int x = lo[0]; x <= hi[0]; ++x) {
        const std::size_t c = std::size_t((z * n_[1] + y) * n_[0] + x);
        for (int i = start_[c]; i < start_[c + 1]; ++i)
          if ((vertices_[std::size_t(index_[std::size_t(i)])] - p).squaredNorm() <= r * r)
            out.push_back(index_[std::size_t(i)]);
      }
  std::sort(out.begin(), out.end());
}

SurfacePaths::SurfacePaths(const TriMesh& mesh)
    : mesh_(mesh), length_(mesh.vertices.size(), std::numeric_limits<double>::infinity()) {
  start_.assign(mesh.vertices.size() + 1, 0);
  for (const auto& t : mesh.triangles)
    for (int v : t) start_[std::size_t(v) + 1] += 2;
  for (std::size_t i = 1; i < start_.size(); ++i) start_[i] += start_[i - 1];
  neighbour_.resize(std::size_t(start_.back()));
  std::vector<int> at(start_.begin(), start_.end() - 1);
  for (const auto& t : mesh.triangles)
    for (std::size_t k = 0; k < 3; ++k)
      for (std::size_t j = 1; j < 3; ++j) neighbour_[std::size_t(at[std::size_t(t[k])]++)] = t[(k + j) % 3];
}

void SurfacePaths::walk(int a, double limit) {
  for (int v : touched_) length_[std::size_t(v)] = std::numeric_limits<double>::infinity();
  touched_.assign(1, a);
  length_[std::size_t(a)] = 0;
  using Entry = std::pair<double, int>;  // ties go to the lower index
  std::priority_queue<Entry, std::vector<Entry>, std::greater<Entry>> open;
  open.push({0, a});
  while (!open.empty()) {
    const auto [length, v] = open.top();
    open.pop();
    if (length > length_[std::size_t(v)]) continue;
    for (int e = start_[std::size_t(v)]; e < start_[std::size_t(v) + 1]; ++e) {
      const int n = neighbour_[std::size_t(e)];
      const double next = length + (mesh_.vertices[std::size_t(n)] - mesh_.vertices[std::size_t(v)]).norm();
      if (next > limit || next >= length_[std::size_t(n)]) continue;
      if (std::isinf(length_[std::size_t(n)])) touched_.push_back(n);
      length_[std::size_t(n)] = next;
      open.push({next, n});
    }
  }
  at_ = a;
  limit_ = limit;
}

bool SurfacePaths::connected(int a, int b, double limit) {
  if (a != at_ || limit > limit_) walk(a, limit);
  return length_[std::size_t(b)] <= limit;
}

std::vector<Vec3> vertex_normals(const TriMesh& mesh) {
  std::vector<Vec3> n(mesh.vertices.size(), Vec3::Zero());
  for (const auto& t : mesh.triangles) {
    const Vec3 &a = mesh.vertices[std::size_t(t[0])], &b = mesh.vertices[std::size_t(t[1])],
               &c = mesh.vertices[std::size_t(t[2])];
    const Vec3 w = (b - a).cross(c - a);
    for (int v : t) n[std::size_t(v)] += w;
  }
  for (Vec3& v : n)
    if (v.norm() > 0) v.normalize();
  return n;
}

}  // namespace insula
