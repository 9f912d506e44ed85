// SPDX-License-Identifier: GPL-3.0-or-later
// What a simulation is given from outside between two steps. A simulation of the same scene that is given the same, in
// the same order, has the same bits. Recordings keep it.
#pragma once
#include <cstdint>
#include <string>

#include "core/mechanics/instrument.h"

namespace insula {

struct SimulationInput {
  enum class Kind : std::int8_t {
    hand,           ///< set_hand(index, hand)
    command,        ///< command(verb, argument)
    complications,  ///< draw_complications(seed)
    horizon,        ///< set_collision_horizon(seconds)
    reset,          ///< reset()
    factor          ///< the solver of body `index` took a factor from the background in this step
  };

  Kind kind = Kind::reset;
  int index = 0;  ///< 0 left, 1 right; of a factor: the body, from 0 in document order
  HandState hand;
  std::string verb, argument;
  std::uint64_t seed = 0;
  double seconds = 0;
};

}  // namespace insula
