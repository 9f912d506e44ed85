// SPDX-License-Identifier: GPL-3.0-or-later
// The perfusion of a tissue from any channel that tells of its blood: a perfusion, a flow, or a flow over that at rest.
#pragma once
#include <string>

#include "core/sim/simulation.h"

namespace insula {

/// Parameters and reading of the channel, for components that own one.
class PerfusionInput {
 public:
  explicit PerfusionInput(Component* owner)
      : owner_(*owner),
        channel_{owner,
                 {.name = "channel",
                  .doc = "a perfusion, a flow, or a flow over that at rest: \"circle.aca_left.perfusion\", "
                         "\"flow.superior.flow_share\""}},
        rest_flow_{owner,
                   {.name = "rest_flow",
                    .fallback = "0 ml/min",
                    .min = "0 ml/min",
                    .max = "2000 ml/min",
                    .doc = "flow at rest; needed if the channel is a flow"}},
        rest_perfusion_{owner,
                        {.name = "rest_perfusion",
                         .fallback = "50 ml/100g/min",
                         .min = "10 ml/100g/min",
                         .max = "150 ml/100g/min",
                         .doc = "perfusion at rest, if the channel is none itself"}} {}

  void find(PrepareContext& context, const Simulation& simulation);
  /// As published at the end of the step before, m3/(s kg). NaN: not known.
  double now() const;

 private:
  const Component& owner_;
  Param<std::string> channel_;
  Param<FlowRate> rest_flow_;
  Param<Perfusion> rest_perfusion_;
  const ChannelEntry* entry_ = nullptr;
  double scale_ = 1;  ///< perfusion over the channel's value
};

}  // namespace insula
