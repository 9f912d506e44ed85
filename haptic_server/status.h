// SPDX-License-Identifier: GPL-3.0-or-later
// From ticks to the figures of HAPTIC_STATUS.
#pragma once
#include <array>
#include <cstdint>
#include <insula_lcm/haptic_status_t.hpp>
#include <string>
#include <vector>

namespace insula {

/// What one tick leaves for the statistics; small, it crosses threads by the thousand.
struct TickSample {
  float lateness_us = 0;
  float solve_us = 0;
  float residual_m = 0;
  std::int16_t sweeps = 0;
  std::int16_t rows = 0;
  bool solved = false;
  /// Per hand: came from a new solve of a recent problem and differs, in any bit, from the tick before. Where nothing
  /// is touched the force itself is next to nothing and so is the difference.
  std::array<bool, 2> fresh{false, false};
  std::array<float, 2> given_J{};  ///< PassivityObserver::given()
};

/// Upper bounds of HAPTIC_STATUS.lateness_count's entries, us; the last entry has none.
inline constexpr std::array<float, 11> lateness_bounds_us{10, 20, 50, 100, 200, 500, 1000, 2000, 5000, 10000, 20000};

/// What to do about a servo that does not keep to its time, in one line; empty when it does. period_us: of its ticks;
/// missed: since the status before.
std::string budget_advice(const insula_lcm::haptic_status_t& status, double period_us, std::int64_t missed);

/// Collects a period (a second) of samples. One thread.
class StatusCollector {
 public:
  void add(const TickSample& sample);
  int ticks() const { return int(lateness_.size()); }
  /// Fills the statistical fields and starts a new period. elapsed_s: the period's length.
  void finish(double elapsed_s, insula_lcm::haptic_status_t& status);

 private:
  std::vector<float> lateness_, solve_;
  std::array<int, 2> fresh_{0, 0};
  std::array<float, 2> given_J_{};
  double sweeps_ = 0, residual_ = 0;
  int rows_ = 0;
};

}  // namespace insula
