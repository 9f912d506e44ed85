// SPDX-License-Identifier: GPL-3.0-or-later
// The stretches of a network of vessels as rules and tools see them: a reference that this family of plugins shares.
// Pictures, reports and the general rules need none of it; they read channels.
#pragma once
#include <string_view>
#include <vector>

#include "core/sim/simulation.h"

namespace insula {

/// A stretch of vessel, or the sac, as the blood sees it.
struct VesselState {
  std::string_view id;      ///< of the network element: "superior", "sac"; lives as long as the simulation
  double pressure = 0;      ///< Pa, of this moment
  double flow = 0;          ///< m3/s, mean of the last heartbeat
  double flow_at_rest = 0;  ///< m3/s, the same before anything was touched
  double lumen = 1;         ///< narrowest cross-section over its own at rest
  double dye = 0;           ///< concentration of indocyanine green, 0..1
};

/// A component that has stretches of vessel.
class VesselSource {
 public:
  virtual ~VesselSource() = default;
  virtual void append_vessels(std::vector<VesselState>& out) const = 0;  ///< as they are now
};

/// All stretches of a scene in document order.
class Vessels {
 public:
  Vessels() = default;
  explicit Vessels(const Simulation& simulation) : sources_(simulation.scene().all<VesselSource>()) {}
  /// As they are now; allocates the first time alone.
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
