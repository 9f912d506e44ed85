// SPDX-License-Identifier: GPL-3.0-or-later
// Forces of the hands on each structure over a run. The force of a step is the larger one of the two hands'. A hand's
// force is the resultant of its tool and of all that the tool holds (core/sim/structure_forces.h).
#pragma once
#include <nlohmann/json_fwd.hpp>
#include <string>
#include <vector>

#include "core/sim/report.h"

namespace insula {

class ForceRecord {
 public:
  struct Figures {
    std::string id;                                                               ///< of the structure
    double max_N = 0;                                                             ///< largest force of a step
    double touched_s = 0;                                                         ///< time with a force
    double impulse_Ns = 0;                                                        ///< integral of the force over time
    double mean_N() const { return touched_s > 0 ? impulse_Ns / touched_s : 0; }  ///< while touched
  };

  /// Called after each step. Allocates only the first time.
  void observe(const StepReport& report);
  const std::vector<Figures>& figures() const { return figures_; }

  /// {structure: {max_N, mean_N, impulse_Ns}} for all structures of the scene, zeros where no hand touched.
  nlohmann::ordered_json json() const;
  /// The touched structures as a table of a page; empty if there are none.
  std::string html() const;

 private:
  std::vector<Figures> figures_;
};

}  // namespace insula
