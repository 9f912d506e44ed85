// SPDX-License-Identifier: GPL-3.0-or-later
// A tool with a mass on the virtual coupling, integrated from tick to tick by implicit Euler as in the engine:
//   (M/dt^2 + C/dt + K) dx = M v/dt - K (s - dd) + C/dt dd + H^T lambda
// s is the tool's displacement from the device, dd the device's displacement in the tick. M and C follow from the
// step's terms A, gain, K:
//   M = h^2 A (1 - gain),   C = h (A gain - K) + 3 sqrt(k/m) M
// The last term is not in the engine. A numerical inertia on a spring oscillates (16 Hz for a clip). The engine's
// longer steps damp this; here each new problem would excite it. The tool keeps its velocity in a new problem, since
// the engine's velocity is the mean of a step.
#pragma once
#include "core/constraint/problem.h"

namespace insula {

class GraspingTool {
 public:
  /// Takes a new problem. If there is no tool yet, it begins at the end of the step h with this velocity. `push`: H^T
  /// lambda there.
  void begin(const ToolTerms& tool, double h, const Vec6& velocity, const Vec6& push) noexcept;
  /// Removes the tool.
  void lose() { there_ = false; }
  /// Sets the length of the tick: dt_s, or age_s for a tool that begins. give() is then (M/dt^2 + C/dt + K)^-1.
  void set_tick(double dt_s, double age_s) noexcept;
  const Mat6& give() const { return give_; }
  /// Displacement from the step's end without lambda, for this displacement of the device from the problem's pose.
  /// went() takes the final displacement.
  Vec6 free_displacement(const Vec6& device) noexcept;
  void went(const Vec6& swept) noexcept;
  const Pose& pose() const { return pose_; }
  const Vec6& stretch() const { return stretch_; }  ///< s, now

 private:
  bool there_ = false, begins_ = false;
  bool puts_right_ = false;  ///< the next tick moves the tool out of obstacles that the new problem has found: a
                             ///< displacement without velocity
  Mat6 mass_ = Mat6::Zero(), damping_ = Mat6::Zero(), stiffness_ = Mat6::Zero(), give_ = Mat6::Zero();
  Pose pose_, device_, problem_device_;
  Vec6 stretch_ = Vec6::Zero(), velocity_ = Vec6::Zero(), device_displacement_ = Vec6::Zero();
  Vec6 ahead_ = Vec6::Zero();  ///< from the step's end, at the arrival of the problem
  double dt_ = 0;
};

}  // namespace insula
