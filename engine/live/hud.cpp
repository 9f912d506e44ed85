// SPDX-License-Identifier: GPL-3.0-or-later
// The state beside the picture, as JSON.
#include "engine/live/hud.h"

#include <cmath>
#include <nlohmann/json.hpp>

#include "engine/reports/clinical_units.h"

namespace insula {
namespace {

using Json = nlohmann::json;

/// With so many digits behind the point: a frame a sixtieth of a second has no room for sixteen.
Json rounded(double v, double digits) {
  const double scale = std::pow(10.0, digits);
  const double r = std::round(v * scale) / scale;
  return std::isfinite(r) ? Json(r) : Json();
}
Json rounded(const Vec3& v, double digits) { return {rounded(v.x(), digits), rounded(v.y(), digits), rounded(v.z(), digits)}; }

void add_exercise(Json& j, const Exercise* exercise, double time) {
  for (const char* key : {"goals", "faults", "timers", "measures"}) j[key] = Json::array();
  j["message"] = "";
  j["state"] = "running";
  j["elapsed_s"] = rounded(time, 3);
  if (!exercise) return;
  const ExerciseLog& log = exercise->log();
  for (const GoalState& g : log.goals()) j["goals"].push_back({{"id", g.id}, {"text", g.text}, {"done", g.done}});
  for (const FaultState& f : log.faults()) j["faults"].push_back({{"id", f.id}, {"text", f.text}, {"count", f.count}});
  for (const TimerState& t : log.timers())
    j["timers"].push_back({{"id", t.id}, {"text", t.text}, {"elapsed_s", rounded(t.elapsed, 2)}, {"limit_s", t.limit}, {"running", t.running}});
  for (const MeasureState& m : log.measures())
    j["measures"].push_back({{"id", m.id}, {"text", m.text}, {"value", m.known ? rounded(m.value, 3) : Json()}, {"unit", m.unit}, {"good", m.good}});
  j["message"] = log.last_message();
  j["state"] = log.state() == ExerciseState::running ? "running" : log.state() == ExerciseState::done ? "done" : "failed";
  if (log.end_time() >= 0) j["elapsed_s"] = rounded(log.end_time(), 3);
}

Json vessels(const StepReport& r) {
  Json out = Json::array();
  for (const VesselState& v : r.vessels)
    out.push_back({{"id", v.id},
                   {"pressure_mmHg", rounded(v.pressure / pascal_per_mmHg, 1)},
                   {"flow_mL_min", rounded(v.flow / m3_s_per_mL_min, 1)},
                   {"flow_percent", v.flow_at_rest != 0 ? rounded(100 * v.flow / v.flow_at_rest, 1) : Json()},
                   {"lumen_percent", rounded(100 * v.lumen, 1)},
                   {"dye", rounded(v.dye, 3)}});
  return out;
}

Json blood(const BleedingState& b, double time) {
  return {{"open", b.open},
          {"rate_mL_min", rounded(b.rate / m3_s_per_mL_min, 1)},
          {"lost_mL", rounded(b.lost / m3_per_mL, 2)},
          {"height_m", rounded(b.height, 6)},
          {"origin", rounded(b.origin, 6)},
          {"up", rounded(b.up, 6)},
          {"radius_m", rounded(b.radius, 6)},
          {"since_s", b.since < 0 ? Json() : rounded(time - b.since, 2)}};
}

Json clips(const StepReport& r) {
  Json out = Json::array();
  for (const ClipState& c : r.clips)
    out.push_back({{"id", c.clip ? c.clip->id : ""},
                   {"state", c.on_tray ? "tray" : c.holder ? "held" : "free"},
                   {"holder", c.holder ? Json(c.holder->id) : Json()},
                   {"opening_rad", rounded(c.opening, 4)},
                   {"force_N", rounded(c.force, 3)},
                   {"applications", c.applications},
                   {"temporary", c.temporary}});
  return out;
}

}  // namespace

std::string hud_json(const Simulation& simulation) {
  const StepReport& r = simulation.report();
  Json j;
  add_exercise(j, simulation.exercise(), r.time);
  j["strands_left"] = r.strands_left;
  j["strands_total"] = r.strands_total;
  j["heart_phase"] = rounded(r.heart_phase, 4);
  j["vessels"] = vessels(r);
  j["clips"] = clips(r);
  // A scene has one field; of several bleedings the one that is open counts, else the deepest.
  const BleedingState* worst = nullptr;
  for (const BleedingState& b : r.bleeding)
    if (!worst || (b.open && !worst->open) || (b.open == worst->open && b.height > worst->height)) worst = &b;
  if (worst) j["blood"] = blood(*worst, r.time);
  j["hands"] = Json::array();
  for (int h = 0; h < 2; ++h)
    if (const Instrument* i = simulation.instrument_of(h)) j["hands"].push_back({{"hand", h == 0 ? "left" : "right"}, {"tool", i->id}});
  return j.dump(-1, ' ', false, Json::error_handler_t::replace);
}

}  // namespace insula
