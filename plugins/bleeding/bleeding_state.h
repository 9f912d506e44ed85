// SPDX-License-Identifier: GPL-3.0-or-later
// State of bleedings for rules and tools of this family of plugins. The page, reports and general rules do not need it.
// They read channels and drawables.
#pragma once
#include <vector>

#include "core/sim/simulation.h"

namespace insula {

/// Blood outside the vessels.
struct BleedingState {
  bool open = false;  ///< there is a tear
  double rate = 0;    ///< present flow of blood out of the tear, m3/s; 0 while it flows back
  double lost = 0;    ///< m3 since the tear, less the volume that flowed back
  double height = 0;  ///< of the blood above the bottom of the field, m; 0: dry
  double since = -1;  ///< simulated time of the rupture, s; -1: none yet
};

/// A component that may bleed.
class BleedingSource {
 public:
  virtual ~BleedingSource() = default;
  virtual BleedingState bleeding() const = 0;  ///< present state
};

/// All bleedings of a scene in document order.
class Bleedings {
 public:
  Bleedings() = default;
  explicit Bleedings(const Simulation& simulation) : sources_(simulation.scene().all<BleedingSource>()) {}
  /// Present states. Allocates only the first time.
  const std::vector<BleedingState>& now() {
    states_.clear();
    for (const BleedingSource* s : sources_) states_.push_back(s->bleeding());
    return states_;
  }

 private:
  std::vector<BleedingSource*> sources_;
  std::vector<BleedingState> states_;
};

}  // namespace insula
