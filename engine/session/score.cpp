// SPDX-License-Identifier: GPL-3.0-or-later
#include "engine/session/score.h"

#include <fmt/format.h>

#include <algorithm>
#include <map>

namespace insula {
namespace {

using Recorded = SessionReader::Metrics;

void compare(const Recorded& recorded, const std::vector<MetricValue>& now, ScoreResult& result) {
  for (const Recorded::Value& old : recorded.values) {
    ++result.metrics_compared;
    const bool same = std::any_of(now.begin(), now.end(), [&](const MetricValue& m) {
      return m.id == old.id && hand_name(m.hand) == old.hand && m.known && m.value == old.value;
    });
    if (same) continue;
    if (++result.metrics_different == 1)
      result.first_different = fmt::format("{} ({}) at {:.2f} s", old.id, old.hand, recorded.time_s);
  }
}

}  // namespace

ScoreResult score(SessionReader& session, const Registry& registry, const RerunSettings& settings) {
  std::map<std::int64_t, Recorded> recorded;  // by number of the step
  if (settings.rules.empty())
    session.metrics([&](const Recorded& m) {
      recorded[m.number] = m;
      return true;
    });
  ScoreResult result;
  std::int64_t number = 0;
  const auto after = [&](const Simulation& simulation) {
    const auto at = recorded.find(++number);
    if (at == recorded.end() || !simulation.exercise()) return;
    compare(at->second, simulation.exercise()->metrics(), result);
  };
  result.rerun = rerun(session, registry, settings, after, [&](const Simulation& simulation) {
    if (simulation.exercise()) result.exercise.emplace(*simulation.exercise());
  });
  return result;
}

}  // namespace insula
