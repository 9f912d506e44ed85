// SPDX-License-Identifier: GPL-3.0-or-later
// Mean square of a point's displacement in a band of frequencies, such as tremor. Each axis passes a high-pass and a
// low-pass Butterworth filter of second order (bilinear transform with the corner frequency kept).
#pragma once
#include <array>
#include <cmath>
#include <numbers>

#include "core/base/math.h"

namespace insula {

class BandPass {
 public:
  void limits(double from_hz, double to_hz) {
    from_hz_ = from_hz;
    to_hz_ = to_hz;
    h_ = 0;
  }
  /// The next position begins anew.
  void restart() { begun_ = false; }
  void reset() {
    restart();
    sum_m2s_ = time_s_ = 0;
  }
  void add(const Vec3& p, double h) {
    if (h != h_) design(h);
    if (!begun_) {
      begun_ = true;
      origin_ = p;
      high_.clear();
      low_.clear();
    }
    sum_m2s_ += h * low_.pass(high_.pass(p - origin_)).squaredNorm();
    time_s_ += h;
  }
  /// Of all axes together, m2; 0 if nothing was added.
  double mean_square() const { return time_s_ > 0 ? sum_m2s_ / time_s_ : 0; }
  double time_s() const { return time_s_; }

 private:
  struct Biquad {
    double b0 = 0, b1 = 0, b2 = 0, a1 = 0, a2 = 0;
    Vec3 z1 = Vec3::Zero(), z2 = Vec3::Zero();
    void clear() { z1 = z2 = Vec3::Zero(); }
    Vec3 pass(const Vec3& x) {
      const Vec3 y = b0 * x + z1;
      z1 = b1 * x - a1 * y + z2;
      z2 = b2 * x - a2 * y;
      return y;
    }
  };
  void design(double h) {
    h_ = h;
    begun_ = false;
    const auto corner = [&](Biquad& q, double hz, bool high) {
      const double k = std::tan(std::numbers::pi * hz * h), norm = 1 / (1 + std::numbers::sqrt2 * k + k * k);
      q.b0 = (high ? 1 : k * k) * norm;
      q.b1 = (high ? -2 : 2) * q.b0;
      q.b2 = q.b0;
      q.a1 = 2 * (k * k - 1) * norm;
      q.a2 = (1 - std::numbers::sqrt2 * k + k * k) * norm;
    };
    corner(high_, from_hz_, true);
    corner(low_, to_hz_, false);
  }

  double from_hz_ = 8, to_hz_ = 12, h_ = 0;
  bool begun_ = false;
  Vec3 origin_ = Vec3::Zero();
  Biquad high_, low_;
  double sum_m2s_ = 0, time_s_ = 0;
};

}  // namespace insula
