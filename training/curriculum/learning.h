// SPDX-License-Identifier: GPL-3.0-or-later
// Statistics of learning, from a row of attempts of one person at one task. All are pure functions.
#pragma once
#include <cstddef>
#include <optional>
#include <span>
#include <vector>

namespace insula {

/// What a cumulative sum of failures has to tell apart.
struct CusumDesign {
  double acceptable = 0.05;    ///< p0: failure rate of somebody who has learnt the task
  double unacceptable = 0.15;  ///< p1: failure rate of somebody who has not
  double alpha = 0.1;          ///< probability of an alarm at the rate p0
  double beta = 0.1;           ///< probability of acceptance at the rate p1
};

/// With P = ln(p1/p0) and Q = ln((1-p0)/(1-p1)):
///   s = Q / (P+Q),  h0 = ln((1-alpha)/beta) / (P+Q),  h1 = ln((1-beta)/alpha) / (P+Q)
/// Sources: Williams, Parry, Schlup, "Quality control: an application of the cusum", BMJ 1992; 304: 1359-61. Bolsin,
/// Colson, "The use of the Cusum technique in the assessment of trainee competence in new procedures", International
/// Journal for Quality in Health Care 2000; 12: 433-8.
struct CusumLimits {
  double s;   ///< a success takes s off the sum, a failure adds 1 - s
  double h0;  ///< a fall of the sum by h0 says that the failure rate is acceptable
  double h1;  ///< a rise of the sum by h1 says that it is unacceptable
};

/// Throws std::invalid_argument unless 0 < p0 < p1 < 1, alpha and beta lie above 0, and their sum lies below 1.
CusumLimits cusum_limits(const CusumDesign& design);

struct Cusum {
  std::vector<double> sum;              ///< after each attempt
  std::optional<std::size_t> accepted;  ///< index of the first attempt after which the sum is at -h0 or below
  std::optional<std::size_t> alarmed;   ///< index of the first attempt after which the sum is at h1 or above
};

/// The sum begins at zero and is not reset. failed: one entry for each attempt, in order of time.
Cusum cusum(const std::vector<bool>& failed, const CusumLimits& limits);

/// Number of attempts until `in_a_row` of them have succeeded one after the other; none: not yet, or in_a_row < 1.
std::optional<int> attempts_to_level(const std::vector<bool>& succeeded, int in_a_row);

/// For each value, the median of it and of the values before it, at most `window` in all. Unknown values (NaN) are left
/// out; where all are unknown, so is the median. An even number of values has the mean of the middle two.
/// Throws std::invalid_argument if the window is 0.
std::vector<double> moving_median(std::span<const double> values, std::size_t window);

}  // namespace insula
