// SPDX-License-Identifier: GPL-3.0-or-later
#include "engine/reports/metric_moments.h"

#include <algorithm>
#include <cmath>

#include "core/sim/exercise.h"

namespace insula {
namespace {
constexpr double period_s = 1;
}

void MetricMoments::observe(double time_s, const Exercise& exercise) {
  if (time_s + 1e-9 < next_s_) return;
  observe(time_s, exercise.metrics());
  next_s_ = std::floor(time_s / period_s + 1e-9) * period_s + period_s;
}

void MetricMoments::observe(double time_s, const std::vector<MetricValue>& metrics) {
  moments_.resize(metrics.size());
  for (std::size_t i = 0; i < metrics.size(); ++i) {
    const MetricValue& m = metrics[i];
    Moment& to = moments_[i];
    to.id = m.id;
    to.hand = m.hand;
    if (!m.known || m.better == Better::none) continue;
    const double worse = m.better == Better::low ? m.value - to.value : to.value - m.value;
    to.value = m.value;
    if (!(worse > to.worst_by)) continue;
    to.worst_by = worse;
    to.worst_s = time_s;
  }
}

std::optional<double> MetricMoments::worst_s(const MetricValue& metric) const {
  const auto found = std::find_if(moments_.begin(), moments_.end(),
                                  [&](const Moment& m) { return m.id == metric.id && m.hand == metric.hand; });
  if (found == moments_.end() || found->worst_by <= 0) return std::nullopt;
  return found->worst_s;
}

}  // namespace insula
