// SPDX-License-Identifier: GPL-3.0-or-later
#include "plugins/ischaemia/perfusion_input.h"

#include <limits>

#include "core/base/text.h"

namespace insula {

void PerfusionInput::find(PrepareContext& context, const Simulation& simulation) {
  entry_ = simulation.channels().find(channel_());
  if (!entry_) {
    const std::string near = nearest_name(channel_(), simulation.channels().ids());
    return owner_.error(context, channel_,
                        "no component publishes the channel " + in_quotes(channel_()) + did_you_mean(near));
  }
  const std::string_view quantity = entry_->channel->quantity().name;
  if (entry_->size() != 1 || (quantity != Perfusion::name && quantity != FlowRate::name && quantity != Scalar::name))
    return owner_.error(context, channel_, in_quotes(channel_()) + " is no perfusion, no flow and no share of a flow");
  if (quantity == FlowRate::name && !(rest_flow_() > 0))
    return owner_.error(context, rest_flow_, "is needed, since " + in_quotes(channel_()) + " is a flow");
  scale_ = quantity == Perfusion::name  ? 1
           : quantity == FlowRate::name ? rest_perfusion_() / rest_flow_()
                                        : rest_perfusion_();
}

double PerfusionInput::now() const {
  return entry_ ? scale_ * *entry_->channel->values(entry_->item) : std::numeric_limits<double>::quiet_NaN();
}

}  // namespace insula
