// SPDX-License-Identifier: GPL-3.0-or-later
// Percentiles and rates of the servo.
#include "haptic_server/status.h"

#include <fmt/format.h>

#include <algorithm>
#include <iterator>

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
  for (std::size_t i = 0; i < 2; ++i) given_J_[i] = std::max(given_J_[i], s.given_J[i]);
  if (!s.solved) return;
  solve_.push_back(s.solve_us);
  sweeps_ += s.sweeps;
  residual_ = std::max(residual_, double(s.residual_m));
  for (std::size_t i = 0; i < 2; ++i) fresh_[i] += s.fresh[i];
}

void StatusCollector::finish(double elapsed_s, insula_lcm::haptic_status_t& status) {
  const double per_s = elapsed_s > 0 ? 1 / elapsed_s : 0;
  status.ticks_per_s = double(lateness_.size()) * per_s;
  for (std::size_t i = 0; i < 2; ++i) {
    status.fresh_forces_per_s[i] = fresh_[i] * per_s;
    status.given_mJ[i] = 1e3 * double(given_J_[i]);
  }
  status.lateness_us_p50 = percentile(lateness_, 0.50);
  status.lateness_us_p99 = percentile(lateness_, 0.99);
  status.lateness_us_max = lateness_.empty() ? 0 : *std::max_element(lateness_.begin(), lateness_.end());
  std::fill(std::begin(status.lateness_count), std::end(status.lateness_count), 0);
  for (const float late : lateness_)
    ++status.lateness_count[std::lower_bound(lateness_bounds_us.begin(), lateness_bounds_us.end(), late) -
                            lateness_bounds_us.begin()];
  status.solve_us_p50 = percentile(solve_, 0.50);
  status.solve_us_p99 = percentile(solve_, 0.99);
  status.sweeps_mean = solve_.empty() ? 0 : sweeps_ / double(solve_.size());
  status.residual_m_max = residual_;
  status.rows = rows_;
  lateness_.clear();
  solve_.clear();
  fresh_ = {0, 0};
  given_J_ = {};
  sweeps_ = residual_ = 0;
}

std::string budget_advice(const insula_lcm::haptic_status_t& s, double period_us, std::int64_t missed) {
  if (!(s.ticks_per_s > 0)) return {};
  if (s.solve_us_p99 > 0.7 * period_us)
    return fmt::format(
        "solving takes {:.0f} us of a tick's {:.0f}: forces come late; less in contact at once ({} rows), or a faster "
        "processor",
        s.solve_us_p99, period_us, s.rows);
  const char* cure = s.realtime ? "end what else runs on this machine, or try --spin 100"
                                : "allow real-time scheduling (manual: Haptics and safety)";
  const double share = double(missed) / (double(missed) + s.ticks_per_s);
  if (share > 0.01) return fmt::format("{:.0f} % of the servo's ticks were missed: {}", 100 * share, cure);
  if (s.lateness_us_p99 > 0.5 * period_us)
    return fmt::format("ticks begin up to {:.0f} us late: {}", s.lateness_us_p99, cure);
  constexpr double much_mJ = 1;  // a loose hand gets less than this from the encoder's resolution
  for (std::size_t i = 0; i < 2; ++i)
    if (s.given_mJ[i] > much_mJ)
      return fmt::format(
          "the {} hand gets energy out of what it touches ({:.1f} mJ), and may feel it buzz: a tool with a softer "
          "coupling, or a firmer grip",
          i == 0 ? "left" : "right", s.given_mJ[i]);
  if (s.residual_m_max > 1e-4)
    return fmt::format(
        "forces are {:.2f} mm from their solution after {:.0f} sweeps of {} rows: less in contact at once",
        1e3 * s.residual_m_max, s.sweeps_mean, s.rows);
  return {};
}

}  // namespace insula
