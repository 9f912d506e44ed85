// SPDX-License-Identifier: GPL-3.0-or-later
// What was asked for in a run, and the complications that were drawn. Part of both reports.
#pragma once
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "core/sim/complications.h"
#include "core/sim/report.h"

namespace insula {

/// The complications as they stood when the report was made.
struct ComplicationsOutcome {
  explicit ComplicationsOutcome(const Complications& c) : seed(c.drawn_from()), drawn(c.drawn()) {}
  std::uint64_t seed;
  std::vector<DrawnComplication> drawn;
};

class RunOutcome {
 public:
  struct Asked {
    double time = 0;
    std::string verb, text;  ///< its argument, or why it was refused
    bool done = true;
  };

  /// What was asked for, among the events of a step or between two.
  void note(const std::vector<Event>& events);

  const std::vector<Asked>& asked() const { return asked_; }  ///< the first 1,000

  /// Adds "commands" to a report.
  void add_to(nlohmann::ordered_json& json) const;
  /// The same as sections of a page; empty when there is nothing to tell.
  std::string html() const;

 private:
  std::vector<Asked> asked_;
};

nlohmann::ordered_json complications_json(const ComplicationsOutcome& complications);
std::string complications_html(const ComplicationsOutcome& complications);

}  // namespace insula
