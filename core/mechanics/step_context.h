// SPDX-License-Identifier: GPL-3.0-or-later
// What every stage of a step may know.
#pragma once
#include <cstdint>

#include "core/base/math.h"

namespace insula {

class EventSink;

struct StepContext {
  double h = 1.0 / 60;  ///< time step, s
  double time = 0;      ///< simulated time at the start of the step, s
  std::int64_t step = 0;
  double collision_horizon_s =
      0;  ///< beyond the step: what tools would meet in it is in the problem already, for the servo
  Vec3 gravity = Vec3::Zero();
  EventSink* events = nullptr;
};

}  // namespace insula
