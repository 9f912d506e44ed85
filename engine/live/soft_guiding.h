// SPDX-License-Identifier: GPL-3.0-or-later
// Whether a cue of the tutor is also a soft force at the hand. A trainee who practises may choose it. A test and a
// demonstration never give one. The haptic server makes the force (haptic_server/soft_guide.h).
//
// It only reads the simulation. What it does to the hands comes back as poses of the devices, which are recorded, so a
// session is run again with the same bits.
#pragma once
#include <optional>

#include "core/sim/simulation.h"
#include "core/sim/tutor.h"
#include "engine/live/session_mode.h"

namespace insula {

/// A guide that lasts.
struct HandGuiding {
  std::int64_t number = 0;  ///< in the session, from 1
  int hand = 0;             ///< 0 left, 1 right
  Vec3 direction = Vec3::UnitZ();
};

class SoftGuiding {
 public:
  static constexpr double force_N = 0.3;     ///< largest: above friction of common arms, far below a grip
  static constexpr double duration_s = 1.2;  ///< with its fades

  void choose(bool on) { chosen_ = on; }
  bool chosen() const { return chosen_; }
  /// After each step: the guide that begins or lasts; none.
  const std::optional<HandGuiding>& step(const Simulation& simulation, SessionMode mode);
  const std::optional<HandGuiding>& now() const { return now_; }

 private:
  bool chosen_ = false;
  std::int64_t number_ = 0;
  double began_s_ = 0;
  std::optional<HandGuiding> now_;
};

}  // namespace insula
