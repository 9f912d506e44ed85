// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/case_builder/level_lines.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <map>
#include <numbers>
#include <queue>

namespace insula::case_builder {
namespace {

constexpr int levels = 160;         // of the distance from a tip, up to the farthest point
constexpr double small_loop = 0.3;  // of the longest loop of a level: less is a bump
constexpr int sure_fork = 4;        // levels in a row with two long loops

}  // namespace

Geodesics::Geodesics(const TriMesh& m) : m_(m), beside_(m.vertices.size()) {
  for (const auto& t : m.triangles)
    for (std::size_t k = 0; k < 3; ++k) beside_[std::size_t(t[k])].push_back(t[(k + 1) % 3]);
}

std::vector<double> Geodesics::from(int start) const {
  std::vector<double> d(beside_.size(), std::numeric_limits<double>::infinity());
  std::priority_queue<std::pair<double, int>, std::vector<std::pair<double, int>>, std::greater<>> open;
  d[std::size_t(start)] = 0, open.emplace(0.0, start);
  while (!open.empty()) {
    const auto [near, v] = open.top();
    open.pop();
    if (near > d[std::size_t(v)]) continue;
    for (const int w : beside(v)) {
      const double next = near + (m_.vertices[std::size_t(w)] - m_.vertices[std::size_t(v)]).norm();
      if (next < d[std::size_t(w)]) d[std::size_t(w)] = next, open.emplace(next, w);
    }
  }
  return d;
}

int farthest_vertex(const std::vector<double>& d) {
  int out = 0;
  for (std::size_t i = 0; i < d.size(); ++i)
    if (std::isfinite(d[i]) && d[i] > d[std::size_t(out)]) out = int(i);
  return out;
}

int nearest_vertex(const TriMesh& m, const Vec3& p) {
  const auto away = [&](const Vec3& v) { return (v - p).squaredNorm(); };
  const auto at = std::min_element(m.vertices.begin(), m.vertices.end(),
                                   [&](const Vec3& a, const Vec3& b) { return away(a) < away(b); });
  return int(at - m.vertices.begin());
}

int root_of(std::vector<int>& parent, int v) {
  while (parent[std::size_t(v)] != v) v = parent[std::size_t(v)] = parent[std::size_t(parent[std::size_t(v)])];
  return v;
}

std::vector<Loop> loops_at(const TriMesh& m, const std::vector<double>& f, double value) {
  std::map<std::pair<int, int>, int> crossed;  // edges, numbered
  std::vector<Vec3> point;
  std::vector<int> parent;
  std::vector<std::array<int, 2>> segments;  // with higher values to their left
  for (const auto& t : m.triangles) {
    int in = -1, out = -1;
    for (std::size_t k = 0; k < 3; ++k) {
      const int from = t[k], to = t[(k + 1) % 3], a = std::min(from, to), b = std::max(from, to);
      const double fa = f[std::size_t(a)] - value, fb = f[std::size_t(b)] - value;
      if ((fa > 0) == (fb > 0)) continue;
      const auto [at, fresh] = crossed.emplace(std::pair(a, b), int(point.size()));
      if (fresh) {
        const double share = fa / (fa - fb);
        point.push_back((1 - share) * m.vertices[std::size_t(a)] + share * m.vertices[std::size_t(b)]);
        parent.push_back(at->second);
      }
      (f[std::size_t(to)] > value ? in : out) = at->second;
    }
    if (in < 0 || out < 0) continue;
    segments.push_back({in, out});
    parent[std::size_t(root_of(parent, in))] = root_of(parent, out);
  }
  std::map<int, std::pair<Loop, Vec3>> loops;  // and twice the area
  for (const auto& [i, j] : segments) {
    const Vec3 &a = point[std::size_t(i)], &b = point[std::size_t(j)];
    auto& [loop, area] = loops.try_emplace(root_of(parent, i), Loop(), Vec3::Zero()).first->second;
    loop.length += (b - a).norm(), loop.middle += (b - a).norm() * 0.5 * (a + b), area += a.cross(b);
  }
  std::vector<Loop> out;
  for (auto& [root, of] : loops) {
    if (!(of.first.length > 0)) continue;
    of.first.middle /= of.first.length;
    of.first.diameter = 2 * std::sqrt(0.5 * of.second.norm() / std::numbers::pi);
    out.push_back(of.first);
  }
  return out;
}

std::vector<Loop> lines_of_distance(const TriMesh& m, const std::vector<double>& d) {
  const double step = d[std::size_t(farthest_vertex(d))] / levels;
  std::vector<Loop> out;
  int divided = 0;  // levels in a row
  for (int k = 1; k < levels && divided < sure_fork; ++k) {
    std::vector<Loop> all = loops_at(m, d, k * step);
    double longest = 0;
    for (const Loop& loop : all) longest = std::max(longest, loop.length);
    std::erase_if(all, [&](const Loop& loop) { return loop.length < small_loop * longest; });  // around bumps
    divided = all.size() > 1 ? divided + 1 : 0;
    if (all.size() == 1) out.push_back(all.front());
  }
  return out;
}

}  // namespace insula::case_builder
