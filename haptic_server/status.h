// SPDX-License-Identifier: GPL-3.0-or-later
// Statistics of the ticks for HAPTIC_STATUS.
#pragma once
#include <array>
#include <cstdint>
#include <insula_lcm/haptic_status_t.hpp>
#include <string>
#include <vector>

namespace insula {

/// Data of one tick for the statistics and for recordings. It is small, since thousands of them pass between threads.
struct TickSample {
  /// Device pose (position m, quaternion w x y z) and force that was sent, N, scene frame; left, right.
  struct Hand {
    std::array<float, 3> p_m{};
    std::array<float, 4> q{1, 0, 0, 0};
    std::array<float, 3> force_N{};
  };
  std::int64_t time_us = 0;
  std::array<Hand, 2> hand{};
  float lateness_us = 0;
  float solve_us = 0;
  float residual_m = 0;
  std::int16_t sweeps = 0;
  std::int16_t rows = 0;
  bool solved = false;
  /// For each hand: whether the force is from a new solve of a recent problem and differs in any bit from the tick
  /// before. Without contact, the force and the difference are nearly zero.
  std::array<bool, 2> fresh{false, false};
  std::array<float, 2> given_J{};  ///< PassivityObserver::given()
};

/// Upper bounds of HAPTIC_STATUS.lateness_count's entries, us; the last entry has none.
inline constexpr std::array<float, 11> lateness_bounds_us{10, 20, 50, 100, 200, 500, 1000, 2000, 5000, 10000, 20000};

/// Advice about a servo that exceeds its time, in one line; empty if it does not. period_us: of its ticks; missed:
/// ticks since the last status.
std::string budget_advice(const insula_lcm::haptic_status_t& status, double period_us, std::int64_t missed);

/// Collects the samples of a period (a second), in one thread.
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
