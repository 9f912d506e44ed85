// SPDX-License-Identifier: GPL-3.0-or-later
#include "engine/reports/exercise_outcome.h"

namespace insula {

using Json = nlohmann::ordered_json;

const char* state_name(ExerciseState state) {
  static constexpr const char* names[] = {"running", "done", "failed"};
  return names[int(state)];
}

Json exercise_json(const std::optional<ExerciseOutcome>& exercise) {
  Json goals = Json::array(), faults = Json::array(), timers = Json::array(), measures = Json::array();
  const auto bound = [](const std::optional<double>& b) { return b ? Json(*b) : Json(); };
  Json out;
  if (exercise) {
    for (const auto& g : exercise->log.goals())
      goals.push_back({{"id", g.id},
                       {"done", g.done},
                       {"time_s", g.done ? Json(g.time) : Json()},
                       {"required", g.required},
                       {"text", g.text}});
    for (const auto& f : exercise->log.faults())
      faults.push_back(
          {{"id", f.id}, {"count", f.count}, {"times_s", f.times}, {"text", f.text}, {"advice", f.advice}});
    for (const auto& t : exercise->log.timers())
      timers.push_back({{"id", t.id},
                        {"elapsed_s", t.elapsed},
                        {"longest_s", t.longest},
                        {"limit_s", t.limit},
                        {"running", t.running},
                        {"text", t.text}});
    for (const auto& m : exercise->log.measures())
      measures.push_back({{"id", m.id},
                          {"value", m.known ? Json(m.value) : Json()},
                          {"unit", m.unit},
                          {"good", m.good},
                          {"band", {bound(m.band[0]), bound(m.band[1])}},
                          {"limit", m.limit},
                          {"text", m.text}});
    out["id"] = exercise->id;
    out["title"] = exercise->title;
    out["state"] = state_name(exercise->log.state());
  }
  out["goals"] = goals;
  out["faults"] = faults;
  out["timers"] = timers;
  out["measures"] = measures;
  return out;
}

}  // namespace insula
