// SPDX-License-Identifier: GPL-3.0-or-later
// Mass, spring and damper of a tool.
#include "haptic_server/grasping_tool.h"

#include <Eigen/LU>
#include <cmath>

namespace insula {
namespace {

constexpr double calm = 3;           // 2 is critical damping, without oscillation
constexpr double farthest_m = 5e-3;  // largest distance from the step's end; beyond it is another tool or position

}  // namespace

void GraspingTool::begin(const ToolTerms& tool, double h, const Vec6& velocity, const Vec6& push) noexcept {
  const Mat6 a = tool.compliance.inverse(), follow = a * tool.gain;
  stiffness_ = tool.stiffness;
  mass_ = h * h * (a - follow);
  damping_ = h * (follow - stiffness_);
  const double mass = mass_.diagonal().head<3>().mean();
  if (mass > 0) damping_ += calm * std::sqrt(stiffness_.diagonal().head<3>().mean() / mass) * mass_;
  dt_ = 0;
  problem_device_ = tool.device;
  const Pose end = displaced(tool.free, tool.compliance * push);
  ahead_ = displacement(end, pose_);
  there_ = there_ && velocity_.allFinite() && ahead_.allFinite() && ahead_.head<3>().norm() < farthest_m;
  begins_ = !there_;
  puts_right_ = there_;
  if (there_) return;
  there_ = true;
  pose_ = end;
  device_ = tool.device;
  stretch_ = displacement(device_, end);
  velocity_ = velocity;
  ahead_.setZero();
}

void GraspingTool::set_tick(double dt, double age) noexcept {
  dt = begins_ ? age : dt;
  begins_ = false;
  if (dt == dt_) return;
  dt_ = dt;
  give_ = (mass_ / (dt * dt) + damping_ / dt + stiffness_).inverse();
}

Vec6 GraspingTool::free_displacement(const Vec6& device) noexcept {
  const Pose now = displaced(problem_device_, device);
  device_displacement_ = displacement(device_, now);
  device_ = now;
  return ahead_ + give_ * (mass_ * velocity_ / dt_ - stiffness_ * (stretch_ - device_displacement_) +
                           damping_ * device_displacement_ / dt_);
}

void GraspingTool::went(const Vec6& swept) noexcept {
  const Vec6 own = swept - ahead_;
  stretch_ += own - device_displacement_;
  if (!puts_right_) velocity_ = own / dt_;
  puts_right_ = false;
  pose_ = displaced(device_, stretch_);
  ahead_.setZero();
}

}  // namespace insula
