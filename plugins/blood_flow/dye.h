// SPDX-License-Identifier: GPL-3.0-or-later
// Indocyanine green in the blood. A bolus arrives with the arterial blood and is carried by the flow, first-order
// upwind and implicit in time. The scheme is stable for any flow. Cells are the stations; a dead end is one well-mixed
// cell.
#pragma once
#include <vector>

#include "plugins/blood_flow/vessel_graph.h"

namespace insula {

/// Concentration of arterial blood, 0..1, `t` (s) after injection into a vein. It is a gamma variate that arrives after
/// 2 s and peaks at 7 s. A tenth of it remains after 20 s.
double arterial_dye(double t);

class DyeTransport {
 public:
  void prepare(const VesselGraph& graph);
  /// inflow and inflow_dye: flow into each node from outside the graph, m3/s, and that flow times concentration.
  void step(VesselGraph& graph, double h, const std::vector<double>& pressure, const std::vector<double>& inflow,
            const std::vector<double>& inflow_dye);
  /// Exchange of a dead end with its junction, m3/s, one for each stretch. It models the mixing in a sac without net
  /// inflow.
  std::vector<double> exchange;
  /// Volume of the mixed cell of a dead end, m3, one for each stretch.
  std::vector<double> volume;
  static double mean(const Stretch& s);  ///< over the blood of a stretch
  void reset(VesselGraph& graph);
  void append_state(const VesselGraph& graph, std::vector<double>& out) const;

 private:
  std::vector<int> order_;
  std::vector<double> in_, dye_, node_;
};

}  // namespace insula
