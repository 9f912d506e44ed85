// SPDX-License-Identifier: GPL-3.0-or-later
// The commands of a run, and its random complications. Both reports contain them.
#pragma once
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "core/sim/complications.h"
#include "core/sim/report.h"

namespace insula {

/// Copy of the complications at the time of the report.
struct ComplicationsOutcome {
  explicit ComplicationsOutcome(const Complications& c) : seed(c.drawn_from()), drawn(c.drawn()) {}
  std::uint64_t seed;
  std::vector<DrawnComplication> drawn;
};

class RunOutcome {
 public:
  struct Asked {
    double time = 0;
    std::string verb, text;  ///< its argument, or the reason for a refusal
    bool done = true;
  };

  /// Takes the commands among the events of a step or between two steps.
  void note(const std::vector<Event>& events);

  const std::vector<Asked>& asked() const { return asked_; }  ///< the first 1,000

  /// Adds "commands" to a report.
  void add_to(nlohmann::ordered_json& json) const;
  /// The same as sections of a page; empty if there are none.
  std::string html() const;

 private:
  std::vector<Asked> asked_;
};

nlohmann::ordered_json complications_json(const ComplicationsOutcome& complications);
std::string complications_html(const ComplicationsOutcome& complications);

}  // namespace insula
