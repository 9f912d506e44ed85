// SPDX-License-Identifier: GPL-3.0-or-later
// Division of a closed surface into chambers.
#include "plugins/pressure/chambers.h"

#include <algorithm>
#include <map>
#include <numeric>

namespace insula {
namespace {

using Edge = std::pair<int, int>;

// Edge (as its triangle runs) -> triangle.
std::map<Edge, int> edges_of(const std::vector<std::array<int, 3>>& triangles) {
  std::map<Edge, int> out;
  for (std::size_t t = 0; t < triangles.size(); ++t)
    for (std::size_t k = 0; k < 3; ++k) out[{triangles[t][k], triangles[t][(k + 1) % 3]}] = int(t);
  return out;
}

}  // namespace

void Chambers::assign(const ShellBody& body, const std::vector<std::vector<std::string>>& groups,
                      std::vector<int>& of) {
  const auto& triangles = body.rest().triangles;
  std::vector<int> chamber_of_region(body.model().regions.size(), -1);
  for (std::size_t g = 0; g < groups.size(); ++g)
    for (const std::string& r : groups[g]) chamber_of_region[std::size_t(body.region(r))] = int(g);
  of.assign(triangles.size(), -1);
  std::vector<int> region(triangles.size()), front;
  for (std::size_t t = 0; t < triangles.size(); ++t) {
    region[t] = body.region_of_triangle(triangles[t]);
    of[t] = chamber_of_region[std::size_t(region[t])];
    if (of[t] >= 0) front.push_back(int(t));
  }
  // Triangles without a chamber are assigned ring by ring from their edges. The lower chamber comes first.
  const auto edges = edges_of(triangles);
  while (!front.empty()) {
    std::map<int, int> next;
    for (int t : front)
      for (std::size_t k = 0; k < 3; ++k) {
        const auto& v = triangles[std::size_t(t)];
        const auto at = edges.find({v[(k + 1) % 3], v[k]});
        if (at == edges.end() || of[std::size_t(at->second)] >= 0) continue;
        const auto [entry, added] = next.try_emplace(at->second, of[std::size_t(t)]);
        if (!added) entry->second = std::min(entry->second, of[std::size_t(t)]);
      }
    front.clear();
    for (auto [t, c] : next) {
      of[std::size_t(t)] = c;
      front.push_back(t);
    }
  }
  for (int& c : of)
    if (c < 0) c = 0;  // a part of the surface that touches no named region
  std::vector<std::vector<int>> votes(chamber_of_region.size(), std::vector<int>(groups.size(), 0));
  for (std::size_t t = 0; t < of.size(); ++t) ++votes[std::size_t(region[t])][std::size_t(of[t])];
  of_region_.clear();
  for (const auto& v : votes) of_region_.push_back(int(std::max_element(v.begin(), v.end()) - v.begin()));
}

void Chambers::build(const ShellBody& body, const std::vector<std::vector<std::string>>& groups) {
  const TriMesh& mesh = body.rest();
  chambers_.assign(groups.size(), {});
  std::vector<int>& of = of_triangle_;
  assign(body, groups, of);
  triangles_ = mesh.triangles;
  origin_ =
      std::accumulate(mesh.vertices.begin(), mesh.vertices.end(), Vec3(Vec3::Zero())) / double(mesh.vertices.size());
  for (std::size_t c = 0; c < groups.size(); ++c) chambers_[c].name = groups[c].front();
  for (std::size_t t = 0; t < of.size(); ++t) {
    Chamber& c = chambers_[std::size_t(of[t])];
    const auto& v = mesh.triangles[t];
    c.triangles.push_back(v);
    c.nodes.insert(c.nodes.end(), v.begin(), v.end());
    const Vec3 &x = mesh.vertices[std::size_t(v[0])], &y = mesh.vertices[std::size_t(v[1])],
               &z = mesh.vertices[std::size_t(v[2])];
    c.area += 0.5 * (y - x).cross(z - x).norm();
  }
  add_borders(mesh.triangles, of, mesh.vertices.size());
  // Node numbers become indices in the chamber's own list.
  for (Chamber& c : chambers_) {
    for (const auto& b : c.border) c.nodes.insert(c.nodes.end(), b.begin(), b.end());
    std::sort(c.nodes.begin(), c.nodes.end());
    c.nodes.erase(std::unique(c.nodes.begin(), c.nodes.end()), c.nodes.end());
    const auto place = [&](int v) {
      return int(std::lower_bound(c.nodes.begin(), c.nodes.end(), v) - c.nodes.begin());
    };
    for (auto& t : c.triangles) t = {place(t[0]), place(t[1]), place(t[2])};
    for (auto& e : c.cones) e = {place(e.a), place(e.b), e.border};
    for (auto& b : c.border)
      for (int& v : b) v = place(v);
  }
}

void Chambers::add_borders(const std::vector<std::array<int, 3>>& triangles, const std::vector<int>& of,
                           std::size_t node_count) {
  // Borders that touch are merged. A single apex then closes every chamber there, even if three meet.
  std::vector<int> parent(node_count);
  std::iota(parent.begin(), parent.end(), 0);
  const auto root = [&](int v) {
    while (parent[std::size_t(v)] != v) v = parent[std::size_t(v)] = parent[std::size_t(parent[std::size_t(v)])];
    return v;
  };
  const auto edges = edges_of(triangles);
  std::vector<std::pair<Edge, int>> border;  // edge, chamber
  for (const auto& [e, t] : edges) {
    const auto back = edges.find({e.second, e.first});
    if (back == edges.end() || of[std::size_t(back->second)] == of[std::size_t(t)]) continue;
    border.push_back({e, of[std::size_t(t)]});
    const int a = root(e.first), b = root(e.second);
    parent[std::size_t(std::max(a, b))] = std::min(a, b);
  }
  std::map<int, std::vector<int>> nodes;  // of each border, by its root
  for (const auto& [e, c] : border) nodes[root(e.first)].push_back(e.first);
  for (auto& [r, list] : nodes) {
    std::sort(list.begin(), list.end());
    list.erase(std::unique(list.begin(), list.end()), list.end());
  }
  std::vector<std::map<int, int>> number(chambers_.size());
  for (const auto& [e, c] : border) {
    Chamber& chamber = chambers_[std::size_t(c)];
    const int r = root(e.first);
    const auto [at, added] = number[std::size_t(c)].try_emplace(r, int(chamber.border.size()));
    if (added) chamber.border.push_back(nodes[r]);
    chamber.cones.push_back({e.second, e.first, at->second});
  }
}

int Chambers::find(std::string_view name) const {
  for (int c = 0; c < count(); ++c)
    if (chambers_[std::size_t(c)].name == name) return c;
  return -1;
}

double Chambers::volume(int index, const VecX& q) const {
  const Chamber& c = chambers_[std::size_t(index)];
  const auto x = [&](int place) -> Vec3 { return q.segment<3>(3 * c.nodes[std::size_t(place)]) - origin_; };
  double six = 0;
  for (const auto& t : c.triangles) six += x(t[0]).dot(x(t[1]).cross(x(t[2])));
  for (std::size_t b = 0; b < c.border.size(); ++b) {
    Vec3 apex = Vec3::Zero(), sum = Vec3::Zero();
    for (int v : c.border[b]) apex += x(v);
    apex /= double(c.border[b].size());
    for (const auto& e : c.cones)
      if (e.border == int(b)) sum += x(e.a).cross(x(e.b));
    six += apex.dot(sum);
  }
  return six / 6;
}

void Chambers::gradient(int index, const VecX& q, std::vector<Vec3>& out) const {
  const Chamber& c = chambers_[std::size_t(index)];
  out.assign(c.nodes.size(), Vec3::Zero());
  const auto x = [&](int place) -> Vec3 { return q.segment<3>(3 * c.nodes[std::size_t(place)]) - origin_; };
  for (const auto& t : c.triangles) {
    const Vec3 a = x(t[0]), b = x(t[1]), d = x(t[2]);
    out[std::size_t(t[0])] += b.cross(d);
    out[std::size_t(t[1])] += d.cross(a);
    out[std::size_t(t[2])] += a.cross(b);
  }
  for (std::size_t k = 0; k < c.border.size(); ++k) {
    Vec3 apex = Vec3::Zero(), sum = Vec3::Zero();
    for (int v : c.border[k]) apex += x(v);
    apex /= double(c.border[k].size());
    for (const auto& e : c.cones) {
      if (e.border != int(k)) continue;
      const Vec3 a = x(e.a), b = x(e.b);
      out[std::size_t(e.a)] += b.cross(apex);
      out[std::size_t(e.b)] += apex.cross(a);
      sum += a.cross(b);
    }
    sum /= double(c.border[k].size());
    for (int v : c.border[k]) out[std::size_t(v)] += sum;
  }
  for (Vec3& g : out) g /= 6;
}

void Chambers::bind(const BlockMatrix& a, const std::vector<int>& free_of_node) {
  edges_.clear();
  const auto edges = edges_of(triangles_);
  for (const auto& [edge, triangle] : edges) {
    const auto [from, to] = edge;
    const int row = free_of_node[std::size_t(from)], column = free_of_node[std::size_t(to)];
    const auto back = edges.find({to, from});
    if (column < 0 || row < column || back == edges.end()) continue;
    const int slot = a.find_slot(row, column);
    if (slot < 0) continue;
    const auto apex = [&, from = from, to = to](int t) {
      const auto& v = triangles_[std::size_t(t)];
      return v[0] + v[1] + v[2] - from - to;
    };
    edges_.push_back({slot, apex(triangle), apex(back->second), of_triangle_[std::size_t(triangle)],
                      of_triangle_[std::size_t(back->second)]});
  }
}

// A triangle (x, y, z) has the volume x . (y cross z) / 6 with the origin, so d2/dx dy = -[z]/6 and d2/dy dx = [z]/6.
void Chambers::add_second_derivative(const VecX& q, std::span<const double> pressure, double scale,
                                     BlockMatrix& a) const {
  for (const CoupledEdge& e : edges_) {
    const double p = (pressure[std::size_t(e.left_chamber)] + pressure[std::size_t(e.right_chamber)]) / 2;
    const Vec3 d = scale * p / 6 * (q.segment<3>(3 * e.right) - q.segment<3>(3 * e.left));
    double* block = a.block(e.slot);  // += [d], column by column
    block[1] += d.z();
    block[2] -= d.y();
    block[3] -= d.z();
    block[5] += d.x();
    block[6] += d.y();
    block[7] -= d.x();
  }
}

}  // namespace insula
