// SPDX-License-Identifier: GPL-3.0-or-later
// What a hand has got out of the simulation, in joules (passivity observer; Hannaford and Ryu, "Time-domain passivity
// control of haptic interfaces", 2002). A passive world gives back no more than was put in; a sampled, delayed one can,
// and then it buzzes. Only observed: the controller that belongs to it, damping by what was given too much, made walls
// softer here instead of stiffer, as it trembles with the encoder (docs/haptics-and-safety.md).
#pragma once
#include "core/base/math.h"

namespace insula {

class PassivityObserver {
 public:
  /// Each tick: the force that was on the hand since the last one, and where the device is now. In free air the count
  /// begins anew.
  void observe(const Vec3& force_N, const Vec3& device_m) noexcept;
  void reset() noexcept { *this = {}; }

  double given() const {
    return given_;
  }  ///< to the hand since it touched, less what the hand put in, J; negative: it put in more
  double most() const { return max_given_; }  ///< largest so far, J

 private:
  double given_ = 0, max_given_ = 0;
  int in_air_ = 0;  ///< ticks without a force
  bool placed_ = false;
  Vec3 last_ = Vec3::Zero();
};

}  // namespace insula
