// SPDX-License-Identifier: GPL-3.0-or-later
// A tool with a mass on the virtual coupling, from tick to tick, by implicit Euler as in the engine:
//   (M/dt^2 + C/dt + K) dx = M v/dt - K (s - dd) + C/dt dd + H^T lambda
// s is the tool's displacement from the device, dd the device's way in the tick. M and C follow from the step's terms
// A, gain, K:
//   M = h^2 A (1 - gain),   C = h (A gain - K) + 3 sqrt(k/m) M
// The last term is not the engine's: a numerical inertia on a spring swings (16 Hz for a clip), the engine's longer
// steps damp that, and undamped it answers their news with swings of its own. The tool goes on through a new problem:
// the engine's velocity is a step's mean.
#pragma once
#include "core/constraint/problem.h"

namespace insula {

class GraspingTool {
 public:
  /// A new problem. Where there is no tool yet it begins at the end of the step h, with this velocity; `push`: H^T
  /// lambda there.
  void begin(const ToolTerms& tool, double h, const Vec6& velocity, const Vec6& push) noexcept;
  /// There is none any more.
  void lose() { there_ = false; }
  /// For a tick of dt_s, or of age_s for one that begins: `give` is (M/dt^2 + C/dt + K)^-1.
  void set_tick(double dt_s, double age_s) noexcept;
  const Mat6& give() const { return give_; }
  /// From the step's end to where it goes with no lambda, the device being so far from the problem's pose; and where it
  /// went.
  Vec6 free_displacement(const Vec6& device) noexcept;
  void went(const Vec6& swept) noexcept;
  const Pose& pose() const { return pose_; }
  const Vec6& stretch() const { return stretch_; }  ///< s, now

 private:
  bool there_ = false, begins_ = false;
  bool puts_right_ =
      false;  ///< the next tick takes the tool out of what the new problem has found in its way: a shift and no throw
  Mat6 mass_ = Mat6::Zero(), damping_ = Mat6::Zero(), stiffness_ = Mat6::Zero(), give_ = Mat6::Zero();
  Pose pose_, device_, problem_device_;
  Vec6 stretch_ = Vec6::Zero(), velocity_ = Vec6::Zero(), device_displacement_ = Vec6::Zero();
  Vec6 ahead_ = Vec6::Zero();  ///< of the step's end, when the problem came
  double dt_ = 0;
};

}  // namespace insula
