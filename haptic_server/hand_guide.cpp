// SPDX-License-Identifier: GPL-3.0-or-later
// Goals of simulated hands.
#include "haptic_server/hand_guide.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace insula {

void HandGuide::place(const Pose& pose) noexcept {
  goal_ = HandGoal{};
  goal_.pose = smooth_ = pose;
  taken_over_ = false;
}

void HandGuide::take_over(const HandSample& wish) noexcept {
  viewer_ = wish;
  if (!taken_over_) smooth_ = goal_.pose;
  taken_over_ = true;
}

const HandGoal& HandGuide::advance(double dt, const HandSample& wish) noexcept {
  if (!(dt > 0)) return goal_;
  HandSample target = taken_over_ ? viewer_ : wish;
  goal_.button1 = target.button1;
  goal_.button2 = target.button2;
  goal_.stops = !taken_over_;  // a mouse is not limited
  if (taken_over_) {
    smooth_ = displaced(smooth_, (dt / (settings_.smoothing_s + dt)) * displacement(smooth_, viewer_.pose));
    target.pose = smooth_;
  }
  Vec6 swept = displacement(goal_.pose, target.pose);
  const double far = swept.head<3>().norm(), turn = swept.tail<3>().norm();
  const bool slowed = far > settings_.max_speed_m_s * dt || turn > settings_.max_spin_rad_s * dt;
  if (far > settings_.max_speed_m_s * dt) swept.head<3>() *= settings_.max_speed_m_s * dt / far;
  if (turn > settings_.max_spin_rad_s * dt) swept.tail<3>() *= settings_.max_spin_rad_s * dt / turn;
  goal_.v = swept.head<3>() / dt;
  goal_.w = swept.tail<3>() / dt;
  goal_.pose = slowed ? displaced(goal_.pose, swept) : target.pose;
  return goal_;
}

void MotionClock::step_arrived(double sim_time, double step_s) noexcept {
  target_ = sim_time;
  end_ = sim_time + step_s;
}

double MotionClock::advance(double dt) noexcept {
  if (!(dt > 0)) return time_;
  target_ = std::min(target_ + dt, end_);
  // Runs at real time with a correction towards the steps' time (time constant 50 ms). A lag of more than a quarter
  // second is skipped.
  if (target_ - time_ > 0.25) time_ = target_;
  const double pulled = time_ + dt + (target_ - time_ - dt) * std::min(1.0, dt / 0.05);
  time_ = std::max(time_, std::min(pulled, end_));
  return time_;
}

void lay_workspace(const Motion* motion, int hand, const Vec3& home, const Vec3& workspace, Vec3& centre,
                   Vec3& extent) {
  centre = home;
  extent = workspace;
  Vec3 low, high;
  if (!motion || !motion->bounds(hand, low, high)) return;
  low = low.cwiseMin(home);
  high = high.cwiseMax(home);
  centre = 0.5 * (low + high);
  const Vec3 box = high - low;
  std::array<int, 3> axes{0, 1, 2};
  // Not stable_sort, which allocates; equal edges keep the order of the axes.
  std::sort(axes.begin(), axes.end(), [&](int a, int b) { return box[a] != box[b] ? box[a] > box[b] : a < b; });
  std::array<double, 3> edges{workspace.x(), workspace.y(), workspace.z()};
  std::sort(edges.begin(), edges.end(), [](double a, double b) { return a > b; });
  for (std::size_t i = 0; i < 3; ++i) extent[axes[i]] = edges[i];
}

}  // namespace insula
