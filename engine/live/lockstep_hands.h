// SPDX-License-Identifier: GPL-3.0-or-later
// Simulated hands that follow a motion in simulated time: the servo's ticks run before each step and know its problem.
// However slow the machine is, the same motion gives the same hands.
#pragma once
#include <algorithm>
#include <cmath>

#include "core/haptics/condense.h"
#include "core/haptics/haptic_update.h"
#include "core/sim/simulation.h"
#include "engine/live/exchange_pause.h"
#include "haptic_server/in_process.h"

namespace insula {

class LockstepHands {
 public:
  /// A hand that the motion does not move stays at its tool's home.
  LockstepHands(const Simulation& simulation, const Motion& motion) : haptics_(motion, homes(simulation)) {}

  void reset() {
    haptics_.reset();
    pause_ = {};
  }
  /// Before a step: runs the ticks up to its end, and sets the hands.
  void before_step(Simulation& simulation) {
    const int ticks = std::max(1, int(std::lround(simulation.h() * 1000)));
    const double start = simulation.time();
    for (int k = 1; k <= ticks; ++k) haptics_.tick(start + k * simulation.h() / ticks);
    for (int h = 0; h < 2; ++h) {
      const auto& hand = haptics_.hand(h);
      if (hand.present) simulation.set_hand(h, {true, hand.device, hand.button1, hand.button2});
    }
  }
  /// After a step: its problem is that of the next ticks.
  void after_step(const Simulation& simulation) {
    haptics_.set_problem(condense_(simulation.problem(), max_problem_rows, condensed_), pause_.hands(simulation));
  }
  const InProcessHaptics& haptics() const { return haptics_; }

 private:
  static std::array<HandHome, 2> homes(const Simulation& simulation) {
    std::array<HandHome, 2> out;
    for (int h = 0; h < 2; ++h)
      if (const Instrument* i = simulation.instrument_of(h)) out[std::size_t(h)] = {true, i->home_pose()};
    return out;
  }

  InProcessHaptics haptics_;
  Condenser condense_;
  ConstraintProblem condensed_;
  ExchangePause pause_;
};

}  // namespace insula
