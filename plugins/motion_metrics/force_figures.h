// SPDX-License-Identifier: GPL-3.0-or-later
// Statistics of a force over the time in which it is above a limit.
#pragma once
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

namespace insula {

class ForceFigures {
 public:
  /// touch_N: smaller forces do not count.
  void limit(double touch_N) { touch_N_ = touch_N; }
  void reset() { *this = ForceFigures(touch_N_); }
  explicit ForceFigures(double touch_N = 0.005) : touch_N_(touch_N) {}

  void add(double force_N, double h) {
    const bool touches = force_N > touch_N_, touched = before_N_ > touch_N_;
    if ((touches || touched) && known_) {
      const double rate = (force_N - before_N_) / h;
      rate2_ += h * rate * rate;
      rate_s_ += h;
    }
    known_ = true;
    before_N_ = force_N;
    if (!touches) return;
    time_s_ += h;
    impulse_Ns_ += h * force_N;
    peak_N_ = std::max(peak_N_, force_N);
    time_in_bin_[bin(force_N)] += h;
  }

  double time_s() const { return time_s_; }
  double impulse_Ns() const { return impulse_Ns_; }
  double mean_N() const { return time_s_ > 0 ? impulse_Ns_ / time_s_ : unknown; }
  double peak_N() const { return time_s_ > 0 ? peak_N_ : unknown; }
  /// Root of the mean squared rate of change while it touches, N/s.
  double rate_N_s() const { return rate_s_ > 0 ? std::sqrt(rate2_ / rate_s_) : unknown; }
  /// The force that is not exceeded in that share of the time; exact to 0.6 %, the width of a bin.
  double percentile_N(double share) const {
    if (!(time_s_ > 0)) return unknown;
    double below = 0;
    for (std::size_t k = 0; k < bins; ++k) {
      const double next = below + time_in_bin_[k];
      if (next >= share * time_s_ && time_in_bin_[k] > 0) {
        const double within = (share * time_s_ - below) / time_in_bin_[k];
        return std::min(peak_N_, least_N * std::exp((double(k) + within) / per_unit));
      }
      below = next;
    }
    return peak_N_;
  }

 private:
  static constexpr double unknown = std::numeric_limits<double>::quiet_NaN();
  // Bins of equal width of the force's logarithm, 1 mN to 100 N.
  static constexpr std::size_t bins = 2000;
  static constexpr double least_N = 1e-3;
  static constexpr double per_unit = double(bins) / 11.512925464970229;  ///< bins for each unit of ln; ln(1e5)
  static std::size_t bin(double force_N) {
    return std::size_t(std::clamp(per_unit * std::log(force_N / least_N), 0.0, double(bins - 1)));
  }

  double touch_N_;
  bool known_ = false;
  double before_N_ = 0, time_s_ = 0, impulse_Ns_ = 0, peak_N_ = 0, rate2_ = 0, rate_s_ = 0;
  std::array<double, bins> time_in_bin_{};
};

}  // namespace insula
