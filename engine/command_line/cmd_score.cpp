// SPDX-License-Identifier: GPL-3.0-or-later
// insula score: recorded sessions by their own rules and metrics, or by those of another scene.
#include <fmt/ostream.h>

#include <nlohmann/json.hpp>

#include "core/base/input_error.h"
#include "engine/command_line/sessions.h"
#include "engine/reports/metrics_report.h"
#include "engine/session/score.h"

namespace insula {
namespace {

using Json = nlohmann::ordered_json;

Json score_json(const std::filesystem::path& file, SessionReader& session, const ScoreResult& r) {
  Json out;
  out["file"] = file.string();
  out["title"] = session.about("title");
  out["same_instructions"] = r.rerun.same_instructions;
  out["steps"] = r.rerun.steps;
  out["states"] = {{"compared", r.rerun.compared}, {"different", r.rerun.different}};
  out["metrics_again"] = {{"compared", r.metrics_compared}, {"different", r.metrics_different}};
  out["broken"] = r.rerun.broken;
  out["exercise"] = exercise_json(r.exercise);
  out["metrics"] = metrics_json(r.exercise ? r.exercise->metrics : std::vector<MetricValue>{});
  return out;
}

void print(std::ostream& out, const std::filesystem::path& file, const ScoreResult& r) {
  fmt::print(out, "{}: {} steps, {} of {} states the same, {} of {} metrics the same\n", file.string(), r.rerun.steps,
             r.rerun.compared - r.rerun.different, r.rerun.compared, r.metrics_compared - r.metrics_different,
             r.metrics_compared);
  if (!r.exercise) return;
  for (const GoalState& g : r.exercise->log.goals())
    fmt::print(out, "  {}  {}\n", g.done ? fmt::format("reached at {:.1f} s", g.time) : "not reached", g.text);
  for (const FaultState& f : r.exercise->log.faults())
    if (f.count > 0) fmt::print(out, "  {} times  {}\n", f.count, f.text);
  for (const MetricValue& m : r.exercise->metrics)
    if (m.known) fmt::print(out, "  {:<40} {:<6} {:>12.{}f} {}\n", m.id, hand_name(m.hand), m.value, m.digits, m.unit);
}

/// Status for this session.
int score_one(const CommandContext& context, const ScoreOptions& options, const std::filesystem::path& file,
              Json& all) {
  try {
    SessionReader session(file);
    RerunSettings settings;
    settings.places = options.places;
    settings.threads = options.threads;
    settings.rules = options.rules;
    const ScoreResult result = score(session, context.registry, settings);
    if (options.json) all.push_back(score_json(file, session, result));
    else print(context.out, file, result);
    if (!result.rerun.broken.empty()) fmt::print(context.err, "error: {}: {}\n", file.string(), result.rerun.broken);
    if (result.rerun.different > 0)
      fmt::print(context.err, "error: {}: the first other state is at {:.2f} s\n", file.string(),
                 result.rerun.first_different_s);
    if (result.metrics_wrong())
      fmt::print(context.err, "error: {}: the first other metric is {}\n", file.string(), result.first_different);
    return result.good() ? 0 : 1;
  } catch (const InputError& e) {
    fmt::print(context.err, "error: {}\n", e.what());
    return 2;
  }
}

}  // namespace

int cmd_score(const CommandContext& context, const ScoreOptions& options) {
  Json all = Json::array();
  int status = 0;
  for (const auto& file : options.files) status = std::max(status, score_one(context, options, file, all));
  if (options.json) fmt::print(context.out, "{}\n", all.dump(2, ' ', false, Json::error_handler_t::replace));
  return status;
}

}  // namespace insula
