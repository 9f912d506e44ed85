// SPDX-License-Identifier: GPL-3.0-or-later
#include "plugins/circle_of_willis/cerebral_network.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

namespace insula {
namespace {

/// Nodes. Those of the left side come first, and those of the right side `sided` later.
enum Node { carotid, siphon, aca, aca_end, m1_end, superior, inferior, pca, pca_end, sided };
constexpr int vertebral_union = 2 * sided, basilar_top = vertebral_union + 1;

struct Artery {
  std::string_view name;
  int from, to;
  double length, radius;  // mm
};

// Alastruey et al. 2007, table 1, where the middle cerebral artery is one of 119 mm. Here it divides after 20 mm, and
// its two branches follow Murray's law (their radius is 2^(-1/3) of the stem's). Its common carotid arteries differ in
// length; both have that of the right one here.
constexpr std::array<Artery, 11> of_a_side{{
    {"cca", CerebralNetwork::arteries, carotid, 177, 2.5},
    {"ica", carotid, siphon, 182, 2.0},
    {"a1", siphon, aca, 12, 1.17},
    {"a2", aca, aca_end, 103, 1.20},
    {"m1", siphon, m1_end, 20, 1.43},
    {"m2_superior", m1_end, superior, 99, 1.135},
    {"m2_inferior", m1_end, inferior, 99, 1.135},
    {"pcom", siphon, pca, 15, 0.73},
    {"p1", basilar_top, pca, 5, 1.07},
    {"p2", pca, pca_end, 86, 1.05},
    {"va", CerebralNetwork::arteries, vertebral_union, 148, 1.36},
}};

struct Share {
  std::string_view name;
  int node;
  double percent;  // of the flow of the brain
};

// Zarrinkoob et al. 2015. The carotid share beyond the named arteries (72 % of both sides) goes to the orbit and the
// choroid, the basilar share beyond the posterior cerebral arteries to the brainstem, the vertebral one beyond the
// basilar artery to the cerebellum. The external carotid artery (`face`) is no part of the brain's flow. It has the
// flow of Alastruey's resistance under 93 mmHg.
constexpr std::array<Share, 6> territories_of_a_side{{{"aca", aca_end, 12},
                                                      {"mca_superior", superior, 10.5},
                                                      {"mca_inferior", inferior, 10.5},
                                                      {"pca", pca_end, 8},
                                                      {"orbit", siphon, 3},
                                                      {"face", carotid, 17.5}}};
constexpr std::array<Share, 2> territories_of_the_middle{
    {{"brainstem", basilar_top, 4}, {"cerebellum", vertebral_union, 8}}};

int on_side(int node, int side) { return node >= 0 && node < sided ? node + side * sided : node; }

}  // namespace

CerebralNetwork complete_circle(double brain_flow) {
  CerebralNetwork n;
  const auto add_segment = [&](std::string name, int from, int to, double length_mm, double radius_mm) {
    n.segments.push_back(
        {.name = std::move(name), .from = from, .to = to, .length = 1e-3 * length_mm, .radius = 1e-3 * radius_mm});
  };
  const auto add_territory = [&](std::string name, int node, double percent) {
    n.territories.push_back({.name = std::move(name), .node = node, .rest_flow = 0.01 * percent * brain_flow});
  };
  for (int side = 0; side < 2; ++side) {
    const std::string end = side == 0 ? "_left" : "_right";
    for (const Artery& a : of_a_side)
      add_segment(std::string(a.name) + end, on_side(a.from, side), on_side(a.to, side), a.length, a.radius);
    for (const Share& t : territories_of_a_side)
      add_territory(std::string(t.name) + end, on_side(t.node, side), t.percent);
    for (const auto& [a, b] : {std::pair(aca_end, superior), {superior, inferior}, {inferior, pca_end}})
      n.anastomoses.push_back({.a = on_side(a, side), .b = on_side(b, side)});
  }
  add_segment("acom", on_side(aca, 0), on_side(aca, 1), 3, 0.74);
  add_segment("basilar", vertebral_union, basilar_top, 29, 1.62);
  for (const Share& t : territories_of_the_middle) add_territory(std::string(t.name), t.node, t.percent);
  return n;
}

CerebralNetwork::Segment* CerebralNetwork::find(std::string_view name) {
  const auto it = std::find_if(segments.begin(), segments.end(), [&](const Segment& s) { return s.name == name; });
  return it == segments.end() ? nullptr : &*it;
}

double CerebralNetwork::conductance(const Segment& s) const {
  if (!(s.radius > 0) || !(s.lumen > 0)) return 0;
  const double open = std::min(s.lumen, 1.0), narrow = std::min(s.narrow_length, s.length);
  const double length = s.length + narrow * (1 / (open * open) - 1);
  return std::numbers::pi * std::pow(s.radius, 4) / (8 * viscosity * length);
}

void CerebralNetwork::set_links(double arterial) {
  int n = 0;
  for (const Segment& s : segments) n = std::max({n, s.from + 1, s.to + 1});
  pressure_.resize(std::size_t(n));
  mesh_.clear(n);
  for (const Segment& s : segments) {
    if (s.from == arteries) mesh_.ground(s.to, conductance(s), arterial);
    else mesh_.link(s.from, s.to, conductance(s));
  }
  for (const Anastomosis& a : anastomoses) mesh_.link(a.a, a.b, a.conductance);
}

/// A node without any way to a given pressure takes that of the veins.
void CerebralNetwork::eliminate() {
  const int n = nodes();
  for (int k = 0; k < n; ++k) mesh_.eliminate(k);
  for (int k = n - 1; k >= 0; --k) pressure_[std::size_t(k)] = mesh_.pressure(k, pressure_.data(), venous);
}

std::string CerebralNetwork::size_beds(double arterial) {
  set_links(arterial);
  for (const Territory& t : territories) mesh_.source(t.node, -t.rest_flow);
  eliminate();
  for (Territory& t : territories) {
    const double drop = pressure(t.node) - venous;
    if (!(drop > 0)) return t.name;
    t.bed = t.rest_flow / drop;
  }
  return {};
}

void CerebralNetwork::solve(double arterial) {
  set_links(arterial);
  for (const Territory& t : territories) mesh_.ground(t.node, t.bed, venous);
  eliminate();
  for (Segment& s : segments)
    s.flow = conductance(s) * ((s.from == arteries ? arterial : pressure(s.from)) - pressure(s.to));
  for (Territory& t : territories) t.flow = t.bed * (pressure(t.node) - venous);
  for (Anastomosis& a : anastomoses) a.flow = a.conductance * (pressure(a.a) - pressure(a.b));
}

}  // namespace insula
