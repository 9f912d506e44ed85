// SPDX-License-Identifier: GPL-3.0-or-later
// A soft force that draws a hand away from a fault (docs/tutor.md). It is a given function of time with a fixed
// direction, so it has no stiffness of its own, and its work is bounded:
//
//   f(t) = F u(t) c(t - t_stop) e         u: up in 0.3 s, 1, down in the last 0.3 s, each a raised cosine
//   c(t) = (1 + cos(pi t / 0.3 s)) / 2    from the moment t_stop at which its messages stop; 1 before
//   e    = min(1, E / 2.5 mJ)             E: energy left of 5 mJ, less what the hand has received, never more
//
// The energy that a hand receives from one guide is at most 5 mJ, over any span of time, while it moves less than 5
// m/s. Guides begin at least nine seconds apart, so their mean power is below 0.6 mW. A hand that follows feels the
// force fade as a spring of at most 100 N/m would. What a hand gives back raises E to 5 mJ at most.
#pragma once
#include <cstdint>
#include <insula_lcm/soft_guide_t.hpp>

#include "core/base/math.h"

namespace insula {

/// What the newest message asks for.
struct GuideWish {
  std::int64_t session = 0, number = 0;  ///< 0: none yet
  std::int64_t receive_ns = 0;
  int hand = 0;
  Vec3 direction = Vec3::UnitZ();  ///< unit, scene frame
  double force_N = 0;
  double duration_s = 0;
};

/// Of one hand. Never allocates, never throws.
class SoftGuide {
 public:
  static constexpr double fade_s = 0.3;         ///< of each fade
  static constexpr double stale_after_s = 0.1;  ///< without a message the guide fades out
  static constexpr double pause_s = 9;          ///< least time from the beginning of a guide to that of the next
  static constexpr double energy_J = 5e-3;      ///< most that a hand receives from one guide

  /// A wish of this hand begins a guide if its number is new and the pause is over. Values out of range begin none.
  void take(const GuideWish& wish) noexcept;
  /// One tick. fresh: the newest wish is no older than stale_after_s and of this session. live: the hand has a live
  /// force. Without it the guide ends at once, since the gate fades all forces out. device_m: position of the hand.
  /// Returns the force on the hand, N, not scaled by the scene's force scale.
  Vec3 advance(double dt, bool fresh, bool live, const Vec3& device_m) noexcept;
  bool active() const { return active_; }
  double given() const { return energy_J - left_; }  ///< energy to the hand by the last guide, J

  /// u of a guide of this duration.
  static double profile(double t, double duration_s) noexcept;
  /// c at this time after the messages have stopped.
  static double fade_out(double t) noexcept;

 private:
  GuideWish wish_;
  std::int64_t last_session_ = 0, last_number_ = 0;
  bool active_ = false, stopped_ = false, placed_ = false;
  double since_s_ = 0, stopped_s_ = 0;
  double resting_s_ = pause_s;  ///< since the last guide began
  double left_ = energy_J;      ///< J
  Vec3 force_ = Vec3::Zero(), last_ = Vec3::Zero();
};

}  // namespace insula
