// SPDX-License-Identifier: GPL-3.0-or-later
// Two scripted hands for the tests of reproducibility: slow loops around home, with the button pressed at times.
#pragma once
#include "core/sim/simulation.h"

namespace insula {

/// Hands for the coming step; polynomials of the step number, so that no library function has an influence.
inline void script_hands(Simulation& simulation) {
  const int n = int(simulation.steps() % 120);
  const double t = n / 120.0, wave = 16 * t * t * (1 - t) * (1 - t), sway = 20 * t * (t - 0.5) * (1 - t);
  for (int hand = 0; hand < 2; ++hand) {
    Instrument* tool = simulation.instrument_of(hand);
    if (!tool) continue;
    HandState state;
    state.present = true;
    state.device = tool->home_pose();
    const Mat3 axes = state.device.q.toRotationMatrix();
    state.device.p += -0.006 * wave * axes.col(2) + (hand == 0 ? 0.002 : -0.003) * sway * axes.col(1);
    state.device.q = (Quat(1, 0.05 * sway, 0, 0.03 * wave).normalized() * state.device.q).normalized();
    state.button1 = n > 20 && n < 100;
    simulation.set_hand(hand, state);
  }
}

}  // namespace insula
