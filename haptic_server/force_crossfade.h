// SPDX-License-Identifier: GPL-3.0-or-later
// From one problem's force to the next one's: what the old problem said last stays, and what it differs by from the new
// one fades.
//
//   force = force of the new problem + gap        gap = old - new at the tick at which the new one came
//
// The gap goes in a straight line: within `within_s`, but by no more a second than `share_per_s` of the largest force
// felt lately. So a step's news come as a slope that is lost among the hand's own changes, and large ones take longer.
// Where the new problem's force comes by itself towards what is felt, that is as much less to hand over; or gaps would
// add up where each problem strays alike.
#pragma once
#include <algorithm>
#include <cmath>

#include "core/base/math.h"

namespace insula {

struct ForceCrossfadeSettings {
  double within_s = 0;      ///< 0: a new problem takes over at once
  double share_per_s = 10;  ///< of the peak: 1 % a millisecond
  double min_N_s = 0.2;     ///< however small the peak; 0.2 mN a millisecond is what no hand tells
  double peak_lasts_s = 5;  ///< time constant with which a peak is forgotten
  double lever_m = 0.1;     ///< a torque counts as this force: about from the grip to the tip
};

/// One hand's. Force and torque of each tick in, what is felt out; nothing is allocated.
class ForceCrossfade {
 public:
  Vec6 operator()(const ForceCrossfadeSettings& s, bool fresh_problem, const Vec6& now, double dt_s) {
    if (fresh_problem && active_) {
      gap_ = last_ - now;
      slope_ = s.within_s > 0 ? size(s, gap_) / s.within_s : 0;
    } else {
      gap_ *= 1 - met(now - now_);
      const double left = size(s, gap_), step = std::min(slope_, std::max(s.min_N_s, s.share_per_s * peak_)) * dt_s;
      gap_ *= s.within_s > 0 && left > step ? 1 - step / left : 0;
    }
    now_ = now;
    last_ = now + gap_;
    peak_ = std::max({size(s, last_), size(s, now_), peak_ * std::exp(-dt_s / s.peak_lasts_s)});
    active_ = true;
    return last_;
  }
  /// Nothing is felt, so there is nothing to hand over; the peak stays.
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
