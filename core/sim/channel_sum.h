// SPDX-License-Identifier: GPL-3.0-or-later
// A channel that several components of a scene have, as one number.
#pragma once
#include <cmath>
#include <string_view>

#include "core/sim/simulation.h"

namespace insula {

/// Sum of the values published last by all scalar channels with this name, SI. What is not known now counts nothing.
inline double channel_sum(const Simulation& simulation, std::string_view name) {
  double sum = 0;
  for (const ChannelEntry& e : simulation.channels().entries())
    if (e.channel->spec().name == name && e.size() == 1)
      if (const double value = *e.channel->values(e.item); !std::isnan(value)) sum += value;
  return sum;
}

}  // namespace insula
