// SPDX-License-Identifier: GPL-3.0-or-later
// State of the stretches of a vessel network for rules and tools of this family of plugins. The page, reports and
// general rules do not need it. They read channels.
#pragma once
#include <string_view>
#include <vector>

#include "core/sim/simulation.h"

namespace insula {

/// State of a stretch of a vessel, or of the sac.
struct VesselState {
  std::string_view id;       ///< of the network element: "superior", "sac"; valid as long as the simulation
  double pressure = 0;       ///< present value, Pa
  double flow = 0;           ///< m3/s, mean of the last heartbeat
  double flow_at_rest = 0;   ///< m3/s, the same before any tool touched the vessel
  double lumen = 1;          ///< narrowest cross-section over its own at rest
  double dye = 0;            ///< concentration of indocyanine green, 0..1
  bool heart_rests = false;  ///< the heart pauses or recovers from it: the flow says nothing of the lumen
};

/// A component that has stretches of vessel.
class VesselSource {
 public:
  virtual ~VesselSource() = default;
  virtual void append_vessels(std::vector<VesselState>& out) const = 0;  ///< present states
};

/// All stretches of a scene in document order.
class Vessels {
 public:
  Vessels() = default;
  explicit Vessels(const Simulation& simulation) : sources_(simulation.scene().all<VesselSource>()) {}
  /// Present states. Allocates only the first time.
  const std::vector<VesselState>& now() {
    states_.clear();
    for (const VesselSource* s : sources_) s->append_vessels(states_);
    return states_;
  }

 private:
  std::vector<VesselSource*> sources_;
  std::vector<VesselState> states_;
};

}  // namespace insula
