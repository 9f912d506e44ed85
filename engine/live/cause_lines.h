// SPDX-License-Identifier: GPL-3.0-or-later
// What is near a hint's limit, as JSON for the instructor's page. Every frame has it, but it is made anew only ten
// times a second: a person reads no faster, and words and numbers cost more than a copy.
#pragma once
#include <cstddef>
#include <nlohmann/json.hpp>

#include "core/sim/tutor.h"
#include "engine/reports/hints_report.h"

namespace insula {

class CauseLines {
 public:
  static constexpr double interval_s = 0.1;  ///< simulated
  static constexpr std::size_t most = 6;     ///< the worst ones

  /// The causes at this simulated time, s, the worst first.
  const nlohmann::json& of(const GivesCues& tutor, double time) {
    // Earlier than the last one: the run has begun again.
    const bool due = tutor_ != &tutor || time < made_s_ || time >= made_s_ + interval_s - 1e-9;
    if (!due) return lines_;
    tutor_ = &tutor;
    made_s_ = time;
    std::vector<HintCause> causes = tutor.causes();
    if (causes.size() > most) causes.resize(most);
    lines_ = nlohmann::json::array();
    for (const HintCause& cause : causes) lines_.push_back(nlohmann::json(hint_json(cause)));
    return lines_;
  }

 private:
  const GivesCues* tutor_ = nullptr;
  double made_s_ = 0;
  nlohmann::json lines_ = nlohmann::json::array();
};

}  // namespace insula
