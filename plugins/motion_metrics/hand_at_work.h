// SPDX-License-Identifier: GPL-3.0-or-later
// Whether a hand works in a step.
#pragma once
#include "core/sim/report.h"

namespace insula {

struct WorkLimits {
  double speed = 0.005;    ///< m/s
  double touch_N = 0.005;  ///< force of the tool's contacts
};

inline bool works(const HandReport& hand, double speed, const WorkLimits& limits) {
  return speed > limits.speed || hand.contact_force > limits.touch_N || hand.button[0] || hand.button[1];
}

}  // namespace insula
