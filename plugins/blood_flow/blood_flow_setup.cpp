// SPDX-License-Identifier: GPL-3.0-or-later
// Openings, chambers and vascular beds of the network, from the vessel and its flow at rest.
#include "plugins/blood_flow/blood_flow.h"

#include <algorithm>
#include <cmath>

#include "core/base/text.h"

namespace insula {

bool BloodFlow::find_ends(PrepareContext& context) {
  const auto& caps = blood_pressure->on->model().caps;
  std::vector<std::string> names;
  double widest = 0;
  for (const Stretch& s : graph_.stretches)
    for (const int node : {s.from, s.to}) {
      const int cap = graph_.nodes[std::size_t(node)].cap;
      if (cap < 0) continue;
      const std::string& name = caps[std::size_t(cap)].name;
      names.push_back(name);
      const Station& end = node == s.from ? s.stations.front() : s.stations.back();
      Outlet o;
      o.node = node;
      o.rest_flow = std::pow(end.rest.area, split());
      outlets_.push_back(o);
      const bool named = inlet().empty() ? name == "inlet" : name == inlet();
      const double rank = named ? infinite : inlet().empty() ? end.rest.area : 0;
      if (rank > widest) {
        widest = rank;
        inlet_node_ = node;
      }
    }
  if (inlet_node_ < 0) {
    const std::string near = nearest_name(inlet(), names);
    error(context, inlet, "no centreline leads to an opening " + in_quotes(inlet()) + did_you_mean(near));
    return false;
  }
  std::erase_if(outlets_, [&](const Outlet& o) { return o.node == inlet_node_; });
  if (outlets_.empty()) {
    error(context, blood_pressure,
          in_quotes(blood_pressure->on->id) + ": the vessel has one opening only; blood needs a way out");
    return false;
  }
  return true;
}

bool BloodFlow::map_chambers(PrepareContext& context) {
  const Chambers& chambers = blood_pressure->chambers();
  main_stretch_.assign(std::size_t(chambers.count()), -1);
  for (std::size_t s = graph_.stretches.size(); s-- > 0;)
    main_stretch_[std::size_t(chambers.of_region(blood_pressure->on->region(graph_.stretches[s].region)))] = int(s);
  place_.assign(graph_.nodes.size(), -1);
  const int first = int(graph_.nodes.size()) - chambers.count();
  for (int c = 0; c < chambers.count(); ++c) {
    const int s = main_stretch_[std::size_t(c)];
    if (s < 0) {
      error(context, blood_pressure,
            "chamber " + in_quotes(chambers.name(c)) +
                " has no centreline, so no blood reaches it; join it to another one");
      return false;
    }
    chamber_node_.push_back(graph_.stretches[std::size_t(s)].middle);
    place_[std::size_t(chamber_node_.back())] = first + c;
  }
  int next = 0;
  for (int& p : place_)
    if (p < 0) p = next++;
  node_at_.assign(place_.size(), 0);
  for (std::size_t i = 0; i < place_.size(); ++i) node_at_[std::size_t(place_[i])] = int(i);
  return true;
}

bool BloodFlow::set_beds(PrepareContext& context) {
  const int n = int(graph_.nodes.size());
  const double mean = blood_pressure->wave_mean();
  upstream_ = flow() / (std::max(upstream_drop(), 1e-7) * mean);
  double parts = 0;
  for (const Outlet& o : outlets_) parts += o.rest_flow;
  for (Outlet& o : outlets_) o.rest_flow *= flow() / parts;
  const auto at = [&](int node) { return place_[std::size_t(node)]; };
  const auto solve_all = [&](std::vector<double>& out) {
    for (int k = 0; k < n; ++k) mesh_.eliminate(k);
    for (int k = n - 1; k >= 0; --k) solved_[std::size_t(k)] = mesh_.pressure(k, solved_.data(), outside());
    out.resize(std::size_t(n));
    for (int k = 0; k < n; ++k) out[std::size_t(node_at_[std::size_t(k)])] = solved_[std::size_t(k)];
  };
  set_links(mesh_);
  mesh_.ground(at(inlet_node_), upstream_, mean);
  for (const Outlet& o : outlets_) mesh_.source(at(o.node), -o.rest_flow);
  solve_all(rest_pressure_);
  rest_flow_.clear();
  for (Branch& b : graph_.branches)
    b.flow = b.conductance * (rest_pressure_[std::size_t(b.a)] - rest_pressure_[std::size_t(b.b)]);
  for (Outlet& o : outlets_) {
    const double p = rest_pressure_[std::size_t(o.node)];
    if (!(p > 1.05 * venous())) {
      error(context, flow,
            "so much does not pass: " + std::to_string(int(p / 133.322387415)) + " mmHg would be left at the outlet " +
                in_quotes(graph_.nodes[std::size_t(o.node)].name));
      return false;
    }
    o.collateral = collateral() * o.rest_flow / (mean - venous());
    o.bed = (o.rest_flow + o.collateral * (mean - p)) / (p - venous());
  }
  // Pressures in the imaged shape: the same network at the pressure of imaging.
  set_links(mesh_);
  const double imaged = blood_pressure->imaged_pressure();
  mesh_.ground(at(inlet_node_), upstream_, imaged);
  for (const Outlet& o : outlets_) {
    mesh_.ground(at(o.node), o.bed, venous());
    mesh_.ground(at(o.node), o.collateral, imaged);
  }
  std::vector<double> p;
  solve_all(p);
  for (int node : chamber_node_) reference_.push_back(p[std::size_t(node)]);
  dye_.prepare(graph_);
  for (std::size_t s = 0; s < graph_.stretches.size(); ++s) {
    if (graph_.stretches[s].dead_end) dye_.exchange[s] = sac_exchange() * flow();
    rest_flow_.push_back(flow_of(graph_.stretches[s], int(s)));
  }
  return true;
}

}  // namespace insula
