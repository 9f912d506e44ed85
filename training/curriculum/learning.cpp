// SPDX-License-Identifier: GPL-3.0-or-later
#include "training/curriculum/learning.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <stdexcept>

namespace insula {
namespace {

double median_of(std::vector<double> values) {
  if (values.empty()) return std::numeric_limits<double>::quiet_NaN();
  std::sort(values.begin(), values.end());
  const std::size_t half = values.size() / 2;
  return values.size() % 2 == 1 ? values[half] : std::midpoint(values[half - 1], values[half]);
}

}  // namespace

CusumLimits cusum_limits(const CusumDesign& design) {
  const auto [p0, p1, alpha, beta] = design;
  if (!(p0 > 0 && p0 < p1 && p1 < 1)) throw std::invalid_argument("failure rates must lie in order between 0 and 1");
  if (!(alpha > 0 && beta > 0 && alpha + beta < 1))
    throw std::invalid_argument("alpha and beta must lie above 0, and their sum below 1");
  const double p = std::log(p1 / p0), q = std::log((1 - p0) / (1 - p1));
  return {q / (p + q), std::log((1 - alpha) / beta) / (p + q), std::log((1 - beta) / alpha) / (p + q)};
}

Cusum cusum(const std::vector<bool>& failed, const CusumLimits& limits) {
  Cusum out;
  double sum = 0;
  for (std::size_t i = 0; i < failed.size(); ++i) {
    sum += failed[i] ? 1 - limits.s : -limits.s;
    out.sum.push_back(sum);
    if (!out.accepted && sum <= -limits.h0) out.accepted = i;
    if (!out.alarmed && sum >= limits.h1) out.alarmed = i;
  }
  return out;
}

std::optional<int> attempts_to_level(const std::vector<bool>& succeeded, int in_a_row) {
  if (in_a_row < 1) return std::nullopt;
  int run = 0;
  for (std::size_t i = 0; i < succeeded.size(); ++i) {
    run = succeeded[i] ? run + 1 : 0;
    if (run == in_a_row) return int(i) + 1;
  }
  return std::nullopt;
}

std::vector<double> moving_median(std::span<const double> values, std::size_t window) {
  if (window == 0) throw std::invalid_argument("a moving median needs a window of one value at least");
  std::vector<double> out;
  for (std::size_t i = 0; i < values.size(); ++i) {
    std::vector<double> known;
    for (std::size_t j = i + 1 - std::min(window, i + 1); j <= i; ++j)
      if (!std::isnan(values[j])) known.push_back(values[j]);
    out.push_back(median_of(std::move(known)));
  }
  return out;
}

}  // namespace insula
