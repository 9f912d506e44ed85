// SPDX-License-Identifier: GPL-3.0-or-later
// Share of the forces on a hand that exceeds the friction of known arms.
#pragma once
#include <array>

#include "engine/reports/report_writer.h"
#include "haptic_server/devices/known_friction.h"

namespace insula {

struct PerceptibleForces {
  double touching_s = 0;  ///< time with more than touch_N on the hand
  double median_N = 0;    ///< in that time
  double largest_N = 0;
  struct Above {
    double time_share = 0;   ///< share of the time in contact with more force than the friction
    double range_share = 0;  ///< share of the range up to the largest force that exceeds the friction
    double scale = 0;        ///< force_scale that brings half of the time in contact above the friction; 0: no contact
  };
  std::array<Above, known_frictions.size()> above{};  ///< in the order of known_frictions

  static constexpr double touch_N = 0.005;
};

/// hand: 0 left, 1 right.
PerceptibleForces perceptible_forces(const RunRecorder& recorder, int hand);

}  // namespace insula
