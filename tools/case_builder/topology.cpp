// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/case_builder/topology.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <set>

#include "core/base/input_error.h"
#include "tools/artery/surface.h"

namespace insula::case_builder {
namespace {

using Edge = std::pair<int, int>;
Edge edge_of(int a, int b) { return a < b ? Edge{a, b} : Edge{b, a}; }

/// Triangles of each edge, edges ascending.
std::vector<std::pair<Edge, int>> edges_of(const TriMesh& m) {
  std::vector<std::pair<Edge, int>> out;
  out.reserve(3 * m.triangles.size());
  for (std::size_t t = 0; t < m.triangles.size(); ++t)
    for (std::size_t k = 0; k < 3; ++k)
      out.emplace_back(edge_of(m.triangles[t][k], m.triangles[t][(k + 1) % 3]), int(t));
  std::sort(out.begin(), out.end());
  return out;
}

/// Triangle across each side; -1 at borders and at edges of three or more.
std::vector<std::array<int, 3>> across(const TriMesh& m) {
  std::vector<std::array<int, 3>> out(m.triangles.size(), {-1, -1, -1});
  const auto edges = edges_of(m);
  for (std::size_t i = 0; i < edges.size();) {
    std::size_t j = i;
    while (j < edges.size() && edges[j].first == edges[i].first) ++j;
    if (j - i == 2)
      for (const auto& [mine, other] : {std::pair(i, i + 1), std::pair(i + 1, i)}) {
        const auto t = std::size_t(edges[mine].second);
        for (std::size_t k = 0; k < 3; ++k)
          if (edge_of(m.triangles[t][k], m.triangles[t][(k + 1) % 3]) == edges[i].first)
            out[t][k] = edges[other].second;
      }
    i = j;
  }
  return out;
}

double twice_area(const TriMesh& m, const std::array<int, 3>& t) {
  const Vec3& a = m.vertices[std::size_t(t[0])];
  return (m.vertices[std::size_t(t[1])] - a).cross(m.vertices[std::size_t(t[2])] - a).norm();
}

}  // namespace

int weld(TriMesh& m, double distance) {
  // Cells of the wanted distance: vertices look into their own and its neighbours.
  std::map<std::array<long, 3>, std::vector<int>> cells;
  std::vector<int> to(m.vertices.size());
  int gone = 0;
  for (std::size_t v = 0; v < m.vertices.size(); ++v) {
    std::array<long, 3> c;
    for (int a = 0; a < 3; ++a) c[std::size_t(a)] = long(std::floor(m.vertices[v][a] / distance));
    to[v] = int(v);
    for (long i = -1; i <= 1 && to[v] == int(v); ++i)
      for (long j = -1; j <= 1 && to[v] == int(v); ++j)
        for (long k = -1; k <= 1 && to[v] == int(v); ++k)
          if (const auto at = cells.find({c[0] + i, c[1] + j, c[2] + k}); at != cells.end())
            for (const int w : at->second)
              if ((m.vertices[std::size_t(w)] - m.vertices[v]).norm() < distance) {
                to[v] = w, ++gone;
                break;
              }
    if (to[v] == int(v)) cells[c].push_back(int(v));
  }
  for (auto& t : m.triangles)
    for (int& v : t) v = to[std::size_t(v)];
  std::erase_if(m.triangles, [](const auto& t) { return t[0] == t[1] || t[1] == t[2] || t[2] == t[0]; });
  artery::number_by_use(m);
  return gone;
}

int drop_doubles(TriMesh& m) {
  std::set<std::array<int, 3>> seen;
  const std::size_t before = m.triangles.size();
  std::erase_if(m.triangles, [&](std::array<int, 3> t) {
    std::sort(t.begin(), t.end());
    return !seen.insert(t).second;
  });
  return int(before - m.triangles.size());
}

BadEdges non_manifold_edges(const TriMesh& m) {
  BadEdges out;
  const auto edges = edges_of(m);
  for (std::size_t i = 0; i < edges.size();) {
    std::size_t j = i;
    while (j < edges.size() && edges[j].first == edges[i].first) ++j;
    if (j - i > 2 && out.count++ == 0) out.first = m.vertices[std::size_t(edges[i].first.first)];
    i = j;
  }
  return out;
}

Pieces pieces_of(const TriMesh& m) {
  const auto beside = across(m);
  Pieces out;
  std::vector<int> of(m.triangles.size(), -1);
  std::vector<std::pair<double, int>> sizes;
  for (std::size_t start = 0; start < of.size(); ++start) {
    if (of[start] >= 0) continue;
    const int piece = int(sizes.size());
    sizes.emplace_back(0.0, piece);
    std::vector<int> list{int(start)};
    of[start] = piece;
    for (std::size_t i = 0; i < list.size(); ++i) {
      sizes.back().first += 0.5 * twice_area(m, m.triangles[std::size_t(list[i])]);
      for (const int n : beside[std::size_t(list[i])])
        if (n >= 0 && of[std::size_t(n)] < 0) of[std::size_t(n)] = piece, list.push_back(n);
    }
  }
  std::stable_sort(sizes.begin(), sizes.end(), [](const auto& a, const auto& b) { return a.first > b.first; });
  std::vector<int> rank(sizes.size());
  for (std::size_t r = 0; r < sizes.size(); ++r)
    rank[std::size_t(sizes[r].second)] = int(r), out.area.push_back(sizes[r].first);
  for (const int p : of) out.of.push_back(rank[std::size_t(p)]);
  return out;
}

void keep_piece(TriMesh& m, const Pieces& pieces, int piece) {
  std::vector<std::array<int, 3>> kept;
  for (std::size_t t = 0; t < m.triangles.size(); ++t)
    if (pieces.of[t] == piece) kept.push_back(m.triangles[t]);
  m.triangles = std::move(kept);
  artery::number_by_use(m);
}

int agree(TriMesh& m) {
  const auto beside = across(m);
  std::vector<int> turned(m.triangles.size(), -1);  // against the first triangle of its piece
  int count = 0;
  for (std::size_t start = 0; start < turned.size(); ++start) {
    if (turned[start] >= 0) continue;
    std::vector<int> list{int(start)};
    turned[start] = 0;
    for (std::size_t i = 0; i < list.size(); ++i) {
      const auto t = std::size_t(list[i]);
      for (std::size_t k = 0; k < 3; ++k) {
        if (beside[t][k] < 0) continue;
        const auto n = std::size_t(beside[t][k]);
        const int a = m.triangles[t][k], b = m.triangles[t][(k + 1) % 3];
        bool same = false;  // both run a -> b: one of them is turned
        for (std::size_t j = 0; j < 3; ++j) same = same || (m.triangles[n][j] == a && m.triangles[n][(j + 1) % 3] == b);
        const int wanted = same ? 1 - turned[t] : turned[t];
        if (turned[n] < 0) turned[n] = wanted, list.push_back(int(n));
        else if (turned[n] != wanted) return -1;
      }
    }
    int ones = 0;
    for (const int t : list) ones += turned[std::size_t(t)];
    const int minority = 2 * ones > int(list.size()) ? 0 : 1;
    for (const int t : list)
      if (turned[std::size_t(t)] == minority)
        std::swap(m.triangles[std::size_t(t)][1], m.triangles[std::size_t(t)][2]), ++count;
  }
  return count;
}

int part_fans(TriMesh& m) {
  std::vector<std::vector<int>> around(m.vertices.size());
  for (std::size_t t = 0; t < m.triangles.size(); ++t)
    for (const int v : m.triangles[t]) around[std::size_t(v)].push_back(int(t));
  const auto beside = across(m);
  int made = 0;
  for (std::size_t v = 0; v < around.size(); ++v) {
    std::set<int> left(around[v].begin(), around[v].end());
    bool first = true;
    while (!left.empty()) {
      std::vector<int> fan{*left.begin()};
      left.erase(left.begin());
      for (std::size_t i = 0; i < fan.size(); ++i)
        for (std::size_t k = 0; k < 3; ++k) {
          const auto& t = m.triangles[std::size_t(fan[i])];
          const int n = beside[std::size_t(fan[i])][k];
          if (n >= 0 && (t[k] == int(v) || t[(k + 1) % 3] == int(v)) && left.erase(n)) fan.push_back(n);
        }
      if (!first) {
        const int copy = int(m.vertices.size());
        m.vertices.push_back(Vec3(m.vertices[v]));
        for (const int t : fan)
          for (int& c : m.triangles[std::size_t(t)])
            if (c == int(v)) c = copy;
        ++made;
      }
      first = false;
    }
  }
  return made;
}

std::vector<std::vector<int>> border_loops(const TriMesh& m) {
  const auto beside = across(m);
  std::map<int, int> next;
  for (std::size_t t = 0; t < m.triangles.size(); ++t)
    for (std::size_t k = 0; k < 3; ++k)
      if (beside[t][k] < 0) next[m.triangles[t][(k + 1) % 3]] = m.triangles[t][k];
  std::vector<std::vector<int>> out;
  while (!next.empty()) {
    auto& loop = out.emplace_back();
    int v = next.begin()->first;
    for (auto at = next.find(v); at != next.end(); at = next.find(v)) {
      loop.push_back(v);
      v = at->second;
      next.erase(at);
    }
    if (v != loop.front())
      throw InputError(
          "the border of the surface is not made of closed lines; make it anew from a grid with --rebuild \"0.2 mm\"");
  }
  return out;
}

double area(const TriMesh& m) {
  double sum = 0;
  for (const auto& t : m.triangles) sum += 0.5 * twice_area(m, t);
  return sum;
}

void append(TriMesh& to, const TriMesh& more) {
  const int first = int(to.vertices.size());
  to.vertices.insert(to.vertices.end(), more.vertices.begin(), more.vertices.end());
  for (const auto& t : more.triangles) to.triangles.push_back({first + t[0], first + t[1], first + t[2]});
}

double signed_volume(const TriMesh& m) {
  double sum = 0;
  if (m.vertices.empty()) return 0;
  const Vec3 o = m.vertices[0];
  for (const auto& t : m.triangles)
    sum += (m.vertices[std::size_t(t[0])] - o)
               .dot((m.vertices[std::size_t(t[1])] - o).cross(m.vertices[std::size_t(t[2])] - o)) /
           6;
  return sum;
}

void turn_inside_out(TriMesh& m) {
  for (auto& t : m.triangles) std::swap(t[1], t[2]);
}

}  // namespace insula::case_builder
