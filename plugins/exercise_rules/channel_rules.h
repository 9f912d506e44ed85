// SPDX-License-Identifier: GPL-3.0-or-later
// What the two rules on a channel share: its name, a comparison, a limit with a unit, and how long it must last.
#pragma once
#include <string>

#include "core/sim/exercise.h"
#include "core/sim/simulation.h"

namespace insula {

/// A channel against a limit. Reports a wrong name or unit at its parameter.
class ChannelWatch {
 public:
  enum class Comparison { above, below };

  /// False when something is wrong, which is reported.
  bool connect(PrepareContext& context, const Simulation& simulation, const Component& rule,
               const Param<std::string>& channel, const Param<std::string>& limit);
  /// The channel now: the length of a vector. NaN: not known.
  double value(const StepReport& report) const;
  /// Whether it is beyond the limit; a value that is not known never is.
  bool beyond(double value, Comparison comparison) const {
    return comparison == Comparison::above ? value > limit_ : value < limit_;
  }
  /// Whether it is back by a tenth of the limit, from where a fault may count again.
  bool back(double value, Comparison comparison) const;

 private:
  const ChannelEntry* entry_ = nullptr;
  double limit_ = 0;  ///< SI
};

}  // namespace insula
