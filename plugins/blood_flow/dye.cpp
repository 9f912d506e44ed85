// SPDX-License-Identifier: GPL-3.0-or-later
// Transport of the dye between nodes in the direction of falling pressure.
#include "plugins/blood_flow/dye.h"

#include <algorithm>
#include <cmath>

namespace insula {

double arterial_dye(double t) {
  const double u = (t - 2) / 5;
  return u > 0 ? u * u * std::exp(2 * (1 - u)) : 0;
}

void DyeTransport::prepare(const VesselGraph& graph) {
  exchange.assign(graph.stretches.size(), 0.0);
  volume.assign(graph.stretches.size(), 0.0);
  order_.resize(graph.branches.size());
  in_.assign(graph.nodes.size(), 0.0);
  dye_.assign(graph.nodes.size(), 0.0);
  node_.assign(graph.nodes.size(), 0.0);
}

void DyeTransport::step(VesselGraph& graph, double h, const std::vector<double>& pressure,
                        const std::vector<double>& inflow, const std::vector<double>& inflow_dye) {
  std::copy(inflow.begin(), inflow.end(), in_.begin());
  std::copy(inflow_dye.begin(), inflow_dye.end(), dye_.begin());
  // Blood flows from high to low pressure, so in this order everything that enters a node is known before it leaves.
  for (std::size_t i = 0; i < order_.size(); ++i) order_[i] = int(i);
  const auto head = [&](int i) {
    const Branch& b = graph.branches[std::size_t(i)];
    return std::max(pressure[std::size_t(b.a)], pressure[std::size_t(b.b)]);
  };
  std::sort(order_.begin(), order_.end(), [&](int i, int j) { return head(i) != head(j) ? head(i) > head(j) : i < j; });
  for (int i : order_) {
    Branch& b = graph.branches[std::size_t(i)];
    Stretch& s = graph.stretches[std::size_t(b.stretch)];
    const bool forward = b.flow >= 0;
    const std::size_t up = std::size_t(forward ? b.a : b.b), down = std::size_t(forward ? b.b : b.a);
    if (in_[up] > 0) node_[up] = dye_[up] / in_[up];
    double c = node_[up];
    const double q = std::abs(b.flow);
    if (s.dead_end) {
      // The sac mixes. As much leaves as enters, and its effect downstream is negligible.
      const double k = volume[std::size_t(b.stretch)] > 0
                           ? h * (exchange[std::size_t(b.stretch)] + (forward ? q : 0)) / volume[std::size_t(b.stretch)]
                           : 0;
      const double mixed = (s.stations.front().dye + k * node_[std::size_t(b.a)]) / (1 + k);
      for (Station& t : s.stations) t.dye = mixed;
      continue;
    }
    for (int n = b.first; n < b.last; ++n) {
      Station& t = s.stations[std::size_t(forward ? n : b.last - 1 - (n - b.first))];
      const double cell = std::max(t.now.area * t.length, 1e-12);
      const double k = h * q / cell;
      t.dye = (t.dye + k * c) / (1 + k);
      c = t.dye;
    }
    in_[down] += q;
    dye_[down] += q * c;
  }
}

double DyeTransport::mean(const Stretch& s) {
  double volume = 0, dye = 0;
  for (const Station& t : s.stations) {
    volume += t.rest.area * t.length;
    dye += t.rest.area * t.length * t.dye;
  }
  return volume > 0 ? dye / volume : 0;
}

void DyeTransport::reset(VesselGraph& graph) {
  for (Stretch& s : graph.stretches)
    for (Station& t : s.stations) t.dye = 0;
  std::fill(node_.begin(), node_.end(), 0.0);
}

void DyeTransport::append_state(const VesselGraph& graph, std::vector<double>& out) const {
  for (const Stretch& s : graph.stretches)
    for (const Station& t : s.stations) out.push_back(t.dye);
  out.insert(out.end(), node_.begin(), node_.end());
}

}  // namespace insula
