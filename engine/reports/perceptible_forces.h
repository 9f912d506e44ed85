// SPDX-License-Identifier: GPL-3.0-or-later
// How much of what a hand was sent it can have felt through an arm with friction of its own.
#pragma once
#include <array>

#include "engine/reports/report_writer.h"
#include "haptic_server/devices/known_friction.h"

namespace insula {

struct PerceptibleForces {
  double touching_s = 0;  ///< with more than touch_N on the hand
  double median_N = 0;    ///< of that time
  double largest_N = 0;
  struct Above {
    double time_share = 0;   ///< of the time in touch with more force than the friction
    double range_share = 0;  ///< of the range up to the largest force that lies above it
    double scale = 0;        ///< force_scale that brings half of the time in touch above it; 0: nothing was touched
  };
  std::array<Above, known_frictions.size()> above{};  ///< in the order of known_frictions

  static constexpr double touch_N = 0.005;
};

/// hand: 0 left, 1 right.
PerceptibleForces perceptible_forces(const RunRecorder& recorder, int hand);

}  // namespace insula
