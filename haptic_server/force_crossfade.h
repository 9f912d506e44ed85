// SPDX-License-Identifier: GPL-3.0-or-later
// Cross-fade from one problem's force to the next one's. The difference between the old and the new force fades out.
//
//   force = force of the new problem + gap        gap = old - new at the first tick of the new problem
//
// The gap decreases linearly within `within_s`, but per second by at most `share_per_s` of the largest recent force. A
// new problem then appears as a slope that is small beside the hand's own changes, and larger gaps take longer. If the
// new problem's force itself moves towards the rendered force, the gap is reduced by that amount. Otherwise gaps would
// accumulate when each problem deviates in the same direction.
#pragma once
#include <algorithm>
#include <cmath>

#include "core/base/math.h"

namespace insula {

struct ForceCrossfadeSettings {
  double within_s = 0;      ///< 0: the new problem's force applies at once
  double share_per_s = 10;  ///< of the peak: 1 % a millisecond
  double min_N_s = 0.2;     ///< lower bound of the slope for small peaks; 0.2 mN a millisecond is imperceptible
  double peak_lasts_s = 5;  ///< time constant with which the peak decays
  double lever_m = 0.1;     ///< torque over this lever counts as force: about the distance from grip to tip
};

/// Cross-fade of one hand. Takes force and torque of each tick, and returns the rendered ones. Allocates nothing.
class ForceCrossfade {
 public:
  Vec6 operator()(const ForceCrossfadeSettings& s, bool fresh_problem, const Vec6& now, double dt_s) {
    if (fresh_problem && active_) {
      gap_ = last_ - now;
      slope_ = s.within_s > 0 ? size(s, gap_) / s.within_s : 0;
    } else {
      gap_ *= 1 - met(now - now_);
    }
    // It begins in the first tick, so that this force is a new one too.
    const double left = size(s, gap_), step = std::min(slope_, std::max(s.min_N_s, s.share_per_s * peak_)) * dt_s;
    gap_ *= s.within_s > 0 && left > step ? 1 - step / left : 0;
    now_ = now;
    last_ = now + gap_;
    peak_ = std::max({size(s, last_), size(s, now_), peak_ * std::exp(-dt_s / s.peak_lasts_s)});
    active_ = true;
    return last_;
  }
  /// Called while no force is rendered, so there is nothing to cross-fade. The peak stays.
  void lost() {
    active_ = false;
    gap_.setZero();
  }

 private:
  /// The share of the gap that a change of the new problem's own force closes.
  double met(const Vec6& change) const {
    const double square = gap_.head<3>().squaredNorm();
    return square > 0 ? std::clamp(gap_.head<3>().dot(change.head<3>()) / square, 0.0, 1.0) : 0;
  }
  static double size(const ForceCrossfadeSettings& s, const Vec6& v) {
    return std::max(v.head<3>().norm(), v.tail<3>().norm() / s.lever_m);
  }

  bool active_ = false;
  Vec6 last_ = Vec6::Zero(), now_ = Vec6::Zero(), gap_ = Vec6::Zero();
  double slope_ = 0, peak_ = 0;
};

}  // namespace insula
