// SPDX-License-Identifier: GPL-3.0-or-later
// Percentiles and rates of the servo.
#include "haptic_server/status.h"

#include <algorithm>

namespace insula {
namespace {

/// Nearest-rank percentile; reorders. 0 for none.
double percentile(std::vector<float>& values, double share) {
  if (values.empty()) return 0;
  const auto rank = std::min(values.size() - 1, std::size_t(share * double(values.size())));
  std::nth_element(values.begin(), values.begin() + std::ptrdiff_t(rank), values.end());
  return values[rank];
}

}  // namespace

void StatusCollector::add(const TickSample& s) {
  lateness_.push_back(s.lateness_us);
  rows_ = s.rows;
  if (!s.solved) return;
  solve_.push_back(s.solve_us);
  sweeps_ += s.sweeps;
  residual_ = std::max(residual_, double(s.residual_m));
  for (std::size_t i = 0; i < 2; ++i) fresh_[i] += s.fresh[i];
}

void StatusCollector::finish(double elapsed_s, insula_lcm::haptic_status_t& status) {
  const double per_s = elapsed_s > 0 ? 1 / elapsed_s : 0;
  status.ticks_per_s = double(lateness_.size()) * per_s;
  for (std::size_t i = 0; i < 2; ++i) status.fresh_forces_per_s[i] = fresh_[i] * per_s;
  status.lateness_us_p50 = percentile(lateness_, 0.50);
  status.lateness_us_p99 = percentile(lateness_, 0.99);
  status.lateness_us_max = lateness_.empty() ? 0 : *std::max_element(lateness_.begin(), lateness_.end());
  status.solve_us_p50 = percentile(solve_, 0.50);
  status.solve_us_p99 = percentile(solve_, 0.99);
  status.sweeps_mean = solve_.empty() ? 0 : sweeps_ / double(solve_.size());
  status.residual_m_max = residual_;
  status.rows = rows_;
  lateness_.clear();
  solve_.clear();
  fresh_ = {0, 0};
  sweeps_ = residual_ = 0;
}

}  // namespace insula
