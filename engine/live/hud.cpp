// SPDX-License-Identifier: GPL-3.0-or-later
// The state beside the image, as JSON.
#include "engine/live/hud.h"

#include <cmath>
#include <nlohmann/json.hpp>

#include "core/sim/tutor.h"
#include "engine/live/cause_lines.h"
#include "engine/reports/exercise_outcome.h"
#include "engine/reports/hints_report.h"

namespace insula {
namespace {

using SortedJson = nlohmann::json;

/// Rounds to so many decimals, so that frames stay small.
SortedJson rounded(double v, double digits) {
  const double scale = std::pow(10.0, digits);
  const double r = std::round(v * scale) / scale;
  return std::isfinite(r) ? SortedJson(r) : SortedJson();
}

void add_exercise(SortedJson& j, const Exercise* exercise, double time) {
  for (const char* key : {"goals", "faults", "timers", "measures"}) j[key] = SortedJson::array();
  j["message"] = "";
  j["state"] = "running";
  j["elapsed_s"] = rounded(time, 3);
  if (!exercise) return;
  const ExerciseLog& log = exercise->log();
  for (const GoalState& g : log.goals()) j["goals"].push_back({{"id", g.id}, {"text", g.text}, {"done", g.done}});
  for (const FaultState& f : log.faults()) {
    SortedJson times = SortedJson::array();
    for (const double t : f.times) times.push_back(rounded(t, 1));
    j["faults"].push_back(
        {{"id", f.id}, {"text", f.text}, {"count", f.count}, {"times_s", times}, {"advice", f.advice}});
  }
  for (const TimerState& t : log.timers())
    j["timers"].push_back({{"id", t.id},
                           {"text", t.text},
                           {"elapsed_s", rounded(t.elapsed, 2)},
                           {"limit_s", t.limit},
                           {"running", t.running}});
  for (const MeasureState& m : log.measures())
    j["measures"].push_back({{"id", m.id},
                             {"text", m.text},
                             {"value", m.known ? rounded(m.value, 3) : SortedJson()},
                             {"unit", m.unit},
                             {"good", m.good},
                             {"limit", m.limit}});
  j["message"] = log.last_message();
  j["state"] = state_name(log.state());
  if (log.end_time() >= 0) j["elapsed_s"] = rounded(log.end_time(), 3);
}

/// The tutor: the last cue, unless this is a test; what is near a cue, for the instructor; all cues after the end.
void add_tutor(SortedJson& j, const Simulation& simulation, const SessionNote& note, CauseLines& causes) {
  const Exercise* exercise = simulation.exercise();
  const SessionMode mode = note.mode;
  SortedJson& out = j["tutor"];
  out["soft_guide"] = note.soft_guide;
  out["guided"] = note.guided < 0 ? "" : std::string(hand_name(note.guided));
  out["cue"] = nullptr;
  out["causes"] = out["cues"] = SortedJson::array();
  const GivesCues* tutor = exercise ? tutor_of(*exercise) : nullptr;
  if (!tutor) return;
  const std::vector<Cue>& cues = tutor->cues();
  if (!cues.empty() && mode != SessionMode::test) out["cue"] = SortedJson(cues_json({cues.back()}).front());
  out["causes"] = causes.of(*tutor, simulation.time());
  if (exercise->log().state() != ExerciseState::running) out["cues"] = SortedJson(cues_json(cues));
}

}  // namespace

std::string hud_json(const Simulation& simulation, const SessionNote& note, CauseLines* kept) {
  const StepReport& r = simulation.report();
  SortedJson j;
  add_exercise(j, simulation.exercise(), r.time);
  CauseLines fresh;
  add_tutor(j, simulation, note, kept ? *kept : fresh);
  j["mode"] = name_of(note.mode);
  j["report"] = note.report;
  j["recording"] = note.recording;
  j["unrecorded"] = note.unrecorded;
  j["hands"] = SortedJson::array();
  for (int h = 0; h < 2; ++h)
    if (const Instrument* i = simulation.instrument_of(h))
      j["hands"].push_back({{"hand", h == 0 ? "left" : "right"}, {"tool", i->id}});
  return j.dump(-1, ' ', false, SortedJson::error_handler_t::replace);
}

}  // namespace insula
