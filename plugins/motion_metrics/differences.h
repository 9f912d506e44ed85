// SPDX-License-Identifier: GPL-3.0-or-later
// Velocity, acceleration and jerk of a point by backward differences of its positions in successive steps.
#pragma once
#include "core/base/math.h"

namespace insula {

class Differences {
 public:
  /// After a gap nothing is known but the next position.
  void restart() { known_ = -1; }
  /// Position at the end of a step of h seconds, m.
  void add(const Vec3& p, double h) {
    const Vec3 v = (p - p_) / h, a = (v - v_) / h, j = (a - a_) / h;
    p_ = p;
    if (known_ >= 0) v_ = v;
    if (known_ >= 1) a_ = a;
    if (known_ >= 2) j_ = j;
    if (known_ < 3) ++known_;
  }
  bool has_velocity() const { return known_ >= 1; }
  bool has_acceleration() const { return known_ >= 2; }
  bool has_jerk() const { return known_ >= 3; }
  const Vec3& position() const { return p_; }      ///< m
  const Vec3& velocity() const { return v_; }      ///< m/s, at the middle of the last step
  const Vec3& acceleration() const { return a_; }  ///< m/s2, at the start of the last step
  const Vec3& jerk() const { return j_; }          ///< m/s3, at the middle of the step before
  /// 0 while it is not known.
  double speed() const { return has_velocity() ? v_.norm() : 0; }

 private:
  int known_ = -1;  ///< order of the highest known derivative
  Vec3 p_ = Vec3::Zero(), v_ = Vec3::Zero(), a_ = Vec3::Zero(), j_ = Vec3::Zero();
};

}  // namespace insula
