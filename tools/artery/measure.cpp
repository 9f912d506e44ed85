// SPDX-License-Identifier: GPL-3.0-or-later
// Sections, calibres and other figures of a finished wall; subdivision and vertex kinds.
#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>

#include "vessel.h"

namespace insula::artery {
namespace {

constexpr double max_sagitta = 0.15;  // of an edge's length: an arc of a third of a circle has 0.14

}  // namespace

std::vector<VertexKind> vertex_kinds(const Surface& s) {
  std::vector<VertexKind> kinds(s.mesh.vertices.size());
  std::vector<char> seen(kinds.size());
  for (std::size_t t = 0; t < s.patch.size(); ++t)
    for (const int v : s.mesh.triangles[t]) {
      VertexKind& k = kinds[std::size_t(v)];
      if (seen[std::size_t(v)] && k.cap != s.patch[t]) k.rim = true;
      k.cap = std::max(seen[std::size_t(v)] ? k.cap : -1, s.patch[t]);
      seen[std::size_t(v)] = 1;
    }
  return kinds;
}

double expected_vertices(const TriMesh& mesh, const std::function<double(const Vec3&)>& edge_length) {
  double sum = 0;  // an equilateral triangle takes sqrt(3)/4 l^2, and two of them go to a vertex
  for (const auto& t : mesh.triangles) {
    const Vec3 &a = mesh.vertices[std::size_t(t[0])], &b = mesh.vertices[std::size_t(t[1])],
               &c = mesh.vertices[std::size_t(t[2])];
    const double l = edge_length((a + b + c) / 3);
    sum += (b - a).cross(c - a).norm() / (std::sqrt(3.0) * l * l);
  }
  return sum;
}

Surface subdivided(const Surface& s, const RemeshGuide& guide) {
  Surface out{{s.mesh.vertices, {}}, {}, s.caps};
  std::map<std::pair<int, int>, std::array<int, 2>> patches;  // of an edge's two triangles
  for (std::size_t t = 0; t < s.patch.size(); ++t)
    for (std::size_t k = 0; k < 3; ++k) {
      const auto [at, fresh] = patches.emplace(std::minmax(s.mesh.triangles[t][k], s.mesh.triangles[t][(k + 1) % 3]),
                                               std::array{s.patch[t], s.patch[t]});
      if (!fresh) at->second[1] = s.patch[t];
    }
  std::map<std::pair<int, int>, int> middles;
  const auto middle = [&](int a, int b) {
    const auto [at, fresh] = middles.emplace(std::minmax(a, b), int(out.mesh.vertices.size()));
    if (fresh) {
      const Vec3 p = 0.5 * (s.mesh.vertices[std::size_t(a)] + s.mesh.vertices[std::size_t(b)]);
      const auto [l, r] = patches.at(std::minmax(a, b));
      const Vec3 on = l != r ? guide.on_rim(std::max(l, r), p) : l >= 0 ? guide.on_cap(l, p) : guide.on_wall(p);
      // In a narrow groove the nearest surface may be the other bank: the middle stays where it is.
      const bool groove =
          (on - p).norm() > max_sagitta * (s.mesh.vertices[std::size_t(a)] - s.mesh.vertices[std::size_t(b)]).norm();
      out.mesh.vertices.push_back(groove ? p : on);
    }
    return at->second;
  };
  for (std::size_t t = 0; t < s.patch.size(); ++t) {
    const auto [a, b, c] = s.mesh.triangles[t];
    const int ab = middle(a, b), bc = middle(b, c), ca = middle(c, a);
    for (const auto& q : {std::array{a, ab, ca}, std::array{b, bc, ab}, std::array{c, ca, bc}, std::array{ab, bc, ca}})
      out.mesh.triangles.push_back(q), out.patch.push_back(s.patch[t]);
  }
  number_by_use(out.mesh);
  return out;
}

double section_diameter(const TriMesh& mesh, const Vec3& point, const Vec3& normal, double reach) {
  // Where the plane crosses edges; each triangle that is crossed joins two of them.
  std::map<std::pair<int, int>, Vec3> crossing;
  std::map<std::pair<int, int>, std::vector<std::pair<int, int>>> joined;
  const auto over = [&](int v) { return (mesh.vertices[std::size_t(v)] - point).dot(normal) > 0; };
  for (const auto& t : mesh.triangles) {
    std::vector<std::pair<int, int>> ends;
    for (std::size_t k = 0; k < 3; ++k) {
      const int a = std::min(t[k], t[(k + 1) % 3]), b = std::max(t[k], t[(k + 1) % 3]);
      if (over(a) == over(b)) continue;
      const Vec3 &p = mesh.vertices[std::size_t(a)], &q = mesh.vertices[std::size_t(b)];
      crossing[{a, b}] = p + (point - p).dot(normal) / (q - p).dot(normal) * (q - p);
      ends.emplace_back(a, b);
    }
    if (ends.size() == 2) joined[ends[0]].push_back(ends[1]), joined[ends[1]].push_back(ends[0]);
  }
  // The loop about the point: of those within reach, the one that winds round it.
  std::map<std::pair<int, int>, bool> done;
  for (const auto& [start, unused] : joined) {
    if (done[start]) continue;
    Vec3 twice_area = Vec3::Zero();
    double angle = 0;
    bool within = true, closed = false;
    auto at = start, before = start;
    while (!done[at]) {
      done[at] = true;
      const auto& n = joined[at];
      if (n.size() != 2) break;
      const auto to = n[0] == before && n[1] != before ? n[1] : n[0] == before ? n[1] : n[0];
      const Vec3 a = crossing[at] - point, b = crossing[to] - point;
      twice_area += a.cross(b);
      angle += std::atan2(a.cross(b).dot(normal), a.dot(b));
      within = within && a.norm() < reach;
      before = at, at = to;
      closed = at == start;
    }
    if (closed && within && std::abs(angle) > std::numbers::pi)
      return 2 * std::sqrt(0.5 * twice_area.norm() / std::numbers::pi);
  }
  return 0;
}

std::vector<std::vector<int>> neighbours(const TriMesh& m) {
  std::vector<std::vector<int>> out(m.vertices.size());
  for (const auto& t : m.triangles)
    for (std::size_t k = 0; k < 3; ++k) out[std::size_t(t[k])].push_back(t[(k + 1) % 3]);
  return out;
}

std::vector<std::vector<int>> connected_pieces(const std::vector<std::vector<int>>& next, std::vector<char> marked) {
  std::vector<std::vector<int>> out;
  for (std::size_t start = 0; start < marked.size(); ++start) {
    if (!marked[start]) continue;
    marked[start] = 0;
    auto& piece = out.emplace_back(std::vector<int>{int(start)});
    for (std::size_t i = 0; i < piece.size(); ++i)
      for (const int n : next[std::size_t(piece[i])])
        if (marked[std::size_t(n)]) marked[std::size_t(n)] = 0, piece.push_back(n);
  }
  return out;
}

void join_fragments(Vessel& v) {
  const auto next = neighbours(v.wall.mesh);
  for (bool any = true; any;) {
    any = false;
    std::map<int, std::vector<std::vector<int>>> pieces;
    std::vector<char> seen(v.region.size());
    for (std::size_t start = 0; start < seen.size(); ++start) {
      if (seen[start]) continue;
      std::vector<int> piece{int(start)};
      seen[start] = 1;
      for (std::size_t i = 0; i < piece.size(); ++i)
        for (const int n : next[std::size_t(piece[i])])
          if (!seen[std::size_t(n)] && v.region[std::size_t(n)] == v.region[start])
            seen[std::size_t(n)] = 1, piece.push_back(n);
      pieces[v.region[start]].push_back(std::move(piece));
    }
    const int ends = int(v.regions.size()) - 1;
    for (auto& [region, list] : pieces) {
      if (region == ends || list.size() < 2 || any) continue;
      std::stable_sort(list.begin(), list.end(), [](const auto& a, const auto& b) { return a.size() > b.size(); });
      std::map<int, int> touched;
      for (const int i : list.back())
        for (const int n : next[std::size_t(i)])
          if (v.region[std::size_t(n)] != region && v.region[std::size_t(n)] != ends)
            ++touched[v.region[std::size_t(n)]];
      if (touched.empty()) continue;
      const auto most = std::max_element(touched.begin(), touched.end(),
                                         [](const auto& a, const auto& b) { return a.second < b.second; });
      for (const int i : list.back()) v.region[std::size_t(i)] = most->first;
      any = true;
    }
  }
}

void measure(Vessel& v) {
  const TriMesh& m = v.wall.mesh;
  auto& d = v.dimensions;
  const Quality q = quality(m);
  d["min_angle_deg"] = q.min_angle_deg, d["mean_min_angle_deg"] = q.mean_min_angle_deg;
  d["shortest_edge"] = q.shortest, d["longest_edge"] = q.longest;
  double area = 0, volume = 0;
  for (const auto& t : m.triangles) {
    const Vec3 &a = m.vertices[std::size_t(t[0])], &b = m.vertices[std::size_t(t[1])],
               &c = m.vertices[std::size_t(t[2])];
    area += 0.5 * (b - a).cross(c - a).norm();
    volume += a.dot(b.cross(c)) / 6;
  }
  d["area_mm2"] = area, d["volume_mm3"] = volume;
  for (const NamedCurve& c : v.centrelines) {
    if (c.name == "sac") continue;
    d[c.name + "_length"] = c.curve.length();
    const CurvePoint middle = at_share(c.curve, 0.6);
    d[c.name + "_diameter"] = section_diameter(m, middle.point, middle.tangent, 2.5 * middle.radius);
  }
  if (!v.neck) return;
  d["neck_diameter"] = section_diameter(m, v.neck->centre, v.neck->normal, 3 * v.neck->diameter);
  double height = 0, width = 0;
  const auto is = [&](std::size_t i, const char* name) { return v.regions[std::size_t(v.region[i])] == name; };
  for (std::size_t i = 0; i < m.vertices.size(); ++i)
    if (is(i, "sac")) height = std::max(height, (m.vertices[i] - v.neck->centre).dot(v.neck->normal));
  v.dome_height = d["dome_height"] = height;
  for (int k = 1; k < 20; ++k)
    width = std::max(width, section_diameter(m, v.neck->centre + 0.05 * k * height * v.neck->normal, v.neck->normal,
                                             3 * v.neck->diameter));
  d["sac_width"] = width;
}

}  // namespace insula::artery
