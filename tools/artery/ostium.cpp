// SPDX-License-Identifier: GPL-3.0-or-later
// The sac as one side of a minimum cut. Triangles are nodes, and a cut through an edge costs its length. The cut
// between the dome's top and the vessels' walls is thus the shortest closed line that parts them. Branches stay out of
// the sac, since their walls and caps are on the other side. Source: Boykov, Kolmogorov 2004 (maximum flow).
#include <algorithm>
#include <boost/graph/adjacency_list.hpp>
#include <boost/graph/boykov_kolmogorov_max_flow.hpp>
#include <map>

#include "import_parts.h"

namespace insula::artery {
namespace {

constexpr double min_sac_share = 0.03;  // of the surface's vertices
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
  if (double(bulging.size()) < min_sac_share * double(m.vertices.size())) return {};
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
