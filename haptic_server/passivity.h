// SPDX-License-Identifier: GPL-3.0-or-later
// Energy that a hand has received from the simulation, J (passivity observer; Hannaford and Ryu, "Time-domain passivity
// control of haptic interfaces", 2002). A passive world returns no more energy than it was given. A sampled and delayed
// one can, and then it vibrates. There is only the observer. The passivity controller made walls softer, since it
// oscillates with the encoder's resolution (docs/haptics-and-safety.md).
#pragma once
#include "core/base/math.h"

namespace insula {

class PassivityObserver {
 public:
  /// Called in each tick with the force on the hand since the last one, and the present position of the device. In free
  /// air the sum starts again.
  void observe(const Vec3& force_N, const Vec3& device_m) noexcept;
  void reset() noexcept { *this = {}; }

  double given() const {
    return given_;
  }  ///< energy to the hand since contact began, less that from the hand, J; negative: the hand gave more
  double most() const { return max_given_; }  ///< largest so far, J

 private:
  double given_ = 0, max_given_ = 0;
  int in_air_ = 0;  ///< ticks without a force
  bool placed_ = false;
  Vec3 last_ = Vec3::Zero();
};

}  // namespace insula
