// SPDX-License-Identifier: GPL-3.0-or-later
// The sac as one side of a minimum cut. Triangles are nodes, and a cut through an edge costs its length. The cut
// between the dome's top and the vessels' walls is thus the shortest closed line that parts them. Branches stay out of
// the sac, since their walls and caps are on the other side. Source: Boykov, Kolmogorov 2004 (maximum flow).
#include <algorithm>
#include <boost/graph/adjacency_list.hpp>
#include <boost/graph/boykov_kolmogorov_max_flow.hpp>
#include <map>
#include <numbers>

#include "import_parts.h"
#include "neck_planes.h"

namespace insula::artery {
namespace {

constexpr double min_sac_share = 0.03;  // of the surface's vertices
constexpr double min_sac_area = 1;      // of the inlet's: the same, of a small dome on long vessels
constexpr double top_share = 0.4;       // of the way up from the first bulge: from here on it is the dome's top
constexpr double higher_costs = 1.5;    // a line at the top costs so much more, since every dome is narrow there

using Traits = boost::adjacency_list_traits<boost::vecS, boost::vecS, boost::directedS>;
using Graph = boost::adjacency_list<
    boost::vecS, boost::vecS, boost::directedS,
    boost::property<
        boost::vertex_index_t, long,
        boost::property<boost::vertex_color_t, boost::default_color_type,
                        boost::property<boost::vertex_distance_t, long,
                                        boost::property<boost::vertex_predecessor_t, Traits::edge_descriptor>>>>,
    boost::property<boost::edge_capacity_t, double,
                    boost::property<boost::edge_residual_capacity_t, double,
                                    boost::property<boost::edge_reverse_t, Traits::edge_descriptor>>>>;

void join(Graph& g, std::size_t a, std::size_t b, double there, double back) {
  const auto e = add_edge(a, b, g).first, r = add_edge(b, a, g).first;
  put(boost::edge_capacity, g, e, there), put(boost::edge_capacity, g, r, back);
  put(boost::edge_reverse, g, e, r), put(boost::edge_reverse, g, r, e);
}

double area_of(const TriMesh& m, const std::vector<int>& vertices) {
  std::vector<char> in(m.vertices.size());
  for (const int i : vertices) in[std::size_t(i)] = 1;
  double sum = 0;
  for (const auto& t : m.triangles) {
    const auto at = [&](std::size_t k) -> const Vec3& { return m.vertices[std::size_t(t[k])]; };
    if (in[std::size_t(t[0])] && in[std::size_t(t[1])] && in[std::size_t(t[2])])
      sum += 0.5 * (at(1) - at(0)).cross(at(2) - at(0)).norm();
  }
  return sum;
}

/// Whether so many vertices may be a sac.
bool is_large(const Surface& s, const std::vector<int>& bulging) {
  const double n = double(bulging.size()), inlet = s.caps.empty() ? 0 : s.caps[0].radius;
  if (n >= min_sac_share * double(s.mesh.vertices.size())) return true;
  return bulging.size() >= 2 * min_sac_vertices && inlet > 0 &&
         area_of(s.mesh, bulging) > min_sac_area * std::numbers::pi * inlet * inlet;
}

}  // namespace

std::vector<int> largest_bulge(const TriMesh& m, const std::vector<double>& radii, double limit) {
  std::vector<char> bulges(radii.size());
  for (std::size_t i = 0; i < radii.size(); ++i) bulges[i] = radii[i] > limit;
  std::vector<std::vector<int>> pieces = connected_pieces(neighbours(m), std::move(bulges));
  const auto largest =
      std::max_element(pieces.begin(), pieces.end(), [](const auto& a, const auto& b) { return a.size() < b.size(); });
  return largest == pieces.end() ? std::vector<int>{} : std::move(*largest);
}

std::vector<char> sac_by_cut(const Surface& s, const std::vector<double>& radii, double bulge) {
  const TriMesh& m = s.mesh;
  const std::vector<int> bulging = largest_bulge(m, radii, bulge);
  if (!is_large(s, bulging)) return {};
  double most = 0;
  for (const int i : bulging) most = std::max(most, radii[std::size_t(i)]);
  std::vector<char> top(m.vertices.size());
  for (const int i : bulging) top[std::size_t(i)] = radii[std::size_t(i)] > bulge + top_share * (most - bulge);

  const std::size_t source = m.triangles.size(), sink = source + 1;
  Graph g(sink + 1);
  double whole = 0;
  std::map<std::pair<int, int>, std::size_t> other;
  for (std::size_t t = 0; t < m.triangles.size(); ++t)
    for (std::size_t k = 0; k < 3; ++k) {
      const int a = m.triangles[t][k], b = m.triangles[t][(k + 1) % 3];
      const auto [at, fresh] = other.emplace(std::minmax(a, b), t);
      if (fresh) continue;
      const double ratio = 0.5 * (radii[std::size_t(a)] + radii[std::size_t(b)]);
      const double up = std::clamp((ratio - bulge) / std::max(most - bulge, 1e-9), 0.0, 1.0);
      const double cost = (m.vertices[std::size_t(a)] - m.vertices[std::size_t(b)]).norm() * (1 + higher_costs * up);
      join(g, t, at->second, cost, cost);
      whole += cost;
    }
  for (std::size_t t = 0; t < m.triangles.size(); ++t) {
    const auto& c = m.triangles[t];
    const auto all = [&](const auto& condition) { return std::all_of(c.begin(), c.end(), condition); };
    if (s.patch[t] >= 0 || all([&](int i) { return radii[std::size_t(i)] < of_a_vessel; })) join(g, t, sink, whole, 0);
    else if (all([&](int i) { return top[std::size_t(i)] != 0; })) join(g, source, t, whole, 0);
  }
  boost::boykov_kolmogorov_max_flow(g, source, sink);
  const auto colour = get(boost::vertex_color, g);
  std::vector<char> out(m.vertices.size());
  for (std::size_t t = 0; t < m.triangles.size(); ++t)
    if (colour[t] == boost::black_color)
      for (const int i : m.triangles[t]) out[std::size_t(i)] = 1;
  return out;
}

}  // namespace insula::artery
