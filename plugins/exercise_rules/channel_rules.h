// SPDX-License-Identifier: GPL-3.0-or-later
// Common part of rules and metrics on a channel: its name, a comparison and a limit with a unit.
#pragma once
#include <string>

#include "core/sim/exercise.h"
#include "core/sim/simulation.h"

namespace insula {

/// Reports an error at the parameter if no component of the scene declares an event of that name.
void check_event(PrepareContext& context, const Simulation& simulation, const Component& owner,
                 const Param<std::string>& event);

/// A channel against a limit. Reports a wrong name or unit at its parameter.
class ChannelWatch {
 public:
  enum class Comparison { above, below };

  /// Finds the channel, and reads the limit in a unit of it. False if there is an error, which is reported.
  bool connect(PrepareContext& context, const Simulation& simulation, const Component& rule,
               const Param<std::string>& channel, const Param<std::string>& limit);
  bool find(PrepareContext& context, const Simulation& simulation, const Component& rule,
            const Param<std::string>& channel);
  const ChannelEntry* entry() const { return entry_; }  ///< null: not found
  double limit() const { return limit_; }               ///< SI
  /// The present value of the channel, or the length of a vector. NaN: not known.
  double value(const StepReport& report) const;
  /// Whether the value is beyond the limit. An unknown value is not.
  bool beyond(double value, Comparison comparison) const {
    return comparison == Comparison::above ? value > limit_ : value < limit_;
  }
  /// Whether the value is back within the limit by a tenth of it. A fault may then count again.
  bool back(double value, Comparison comparison) const;

 private:
  const ChannelEntry* entry_ = nullptr;
  double limit_ = 0;  ///< SI
};

/// Of a parameter with the choices "above" and "below".
ChannelWatch::Comparison comparison_of(const Param<Choice>& side);

}  // namespace insula
