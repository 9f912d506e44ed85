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
  stale_ = stale_ || taken_over_;
  taken_over_ = returning_ = false;
}

void HandGuide::take_over(const HandSample& wish) noexcept {
  silent_s_ = 0;
  if (stale_) return;
  viewer_ = wish;
  if (!taken_over_) smooth_ = goal_.pose;
  taken_over_ = true;
  returning_ = false;
}

void HandGuide::release() noexcept {
  stale_ = false;
  if (!taken_over_) return;
  taken_over_ = false;
  returning_ = true;
  returning_s_ = 0;
}

void HandGuide::move_towards(const Pose& target, double dt, double most_m, double most_rad) noexcept {
  Vec6 swept = displacement(goal_.pose, target);
  const double far = swept.head<3>().norm(), turn = swept.tail<3>().norm();
  const bool slowed = far > most_m || turn > most_rad;
  if (far > most_m) swept.head<3>() *= most_m / far;
  if (turn > most_rad) swept.tail<3>() *= most_rad / turn;
  goal_.v = swept.head<3>() / dt;
  goal_.w = swept.tail<3>() / dt;
  goal_.pose = slowed ? displaced(goal_.pose, swept) : target;
  returning_ = returning_ && slowed;
}

void HandGuide::glide_back(double dt, const HandSample& wish) noexcept {
  returning_s_ += dt;
  const double pace = std::min(1.0, returning_s_ / settings_.return_ramp_s);
  goal_.button1 = goal_.button2 = false;
  goal_.stops = false;
  move_towards(wish.pose, dt, pace * settings_.return_speed_m_s * dt, pace * settings_.return_spin_rad_s * dt);
}

const HandGoal& HandGuide::advance(double dt, const HandSample& wish) noexcept {
  if (!(dt > 0)) return goal_;
  silent_s_ += dt;
  if (silent_s_ > settings_.fresh_after_s) stale_ = false;
  if (taken_over_ && silent_s_ > settings_.lost_after_s) release();
  if (returning_) {
    glide_back(dt, wish);
    return goal_;
  }
  HandSample target = taken_over_ ? viewer_ : wish;
  goal_.button1 = target.button1;
  goal_.button2 = target.button2;
  goal_.stops = !taken_over_;  // a mouse is not limited
  if (taken_over_) {
    smooth_ = displaced(smooth_, (dt / (settings_.smoothing_s + dt)) * displacement(smooth_, viewer_.pose));
    target.pose = smooth_;
  }
  move_towards(target.pose, dt, settings_.max_speed_m_s * dt, settings_.max_spin_rad_s * dt);
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
