// SPDX-License-Identifier: GPL-3.0-or-later
// What became of the patient in a run: bleeding, vessels, clips, and what was asked for on the way. Part of both reports.
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
  struct Bleeding {
    double lost = 0;        ///< m3
    double open_time = 0;   ///< s with blood coming out
    double highest = 0;     ///< of the blood in the field, m
    double first = -1;      ///< simulated time of the rupture, s; -1: none
    bool open = false;      ///< blood comes out at the end
  };
  struct Vessel {
    std::string id;
    double pressure = 0, flow = 0, flow_at_rest = 0, lumen = 1;  ///< SI
  };
  struct Clip {
    std::string id, holder;
    bool on_tray = true, temporary = false;
    double force = 0;
    int applications = 0;
  };
  struct Asked {
    double time = 0;
    std::string verb, text;  ///< its argument, or why it was refused
    bool done = true;
  };

  void observe(const StepReport& report);
  /// What was asked for, among the events of a step or between two.
  void note(const std::vector<Event>& events);

  /// All bleedings of the scene together.
  const Bleeding& bleeding() const { return bleeding_; }
  const std::vector<Vessel>& vessels() const { return vessels_; }  ///< at the end
  const std::vector<Clip>& clips() const { return clips_; }        ///< at the end
  const std::vector<Asked>& asked() const { return asked_; }       ///< the first 1,000

  /// Adds "bleeding", "vessels", "clips", "commands" to a report.
  void add_to(nlohmann::ordered_json& json) const;
  /// The same as sections of a page; empty when there is nothing to tell.
  std::string html() const;

 private:
  bool bleeds_ = false;  // the scene can bleed
  Bleeding bleeding_;
  std::vector<Vessel> vessels_;
  std::vector<Clip> clips_;
  std::vector<Asked> asked_;
};

nlohmann::ordered_json complications_json(const ComplicationsOutcome& complications);
std::string complications_html(const ComplicationsOutcome& complications);

}  // namespace insula
