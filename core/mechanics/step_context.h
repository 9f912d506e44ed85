// SPDX-License-Identifier: GPL-3.0-or-later
// Data that every stage of a step may use.
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
      0;  ///< time beyond the step for which the problem already contains the contacts of tools, for the servo
  Vec3 gravity = Vec3::Zero();
  EventSink* events = nullptr;
};

}  // namespace insula
