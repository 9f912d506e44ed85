// SPDX-License-Identifier: GPL-3.0-or-later
#include "viewer/gateway/learning_json.h"

#include "training/curriculum/learning.h"

namespace insula::gateway {
namespace {

using Ordered = nlohmann::ordered_json;

constexpr int expert_in_a_row = 3;

template <class T>
Ordered known_or_null(const std::optional<T>& value) {
  return value ? Ordered(*value) : Ordered();
}

bool reaches(const training::LearningCurve::Point& point, const Level& level) {
  return point.done && (!level.at_least || point.value >= *level.at_least) &&
         (!level.at_most || point.value <= *level.at_most);
}

void add_level(Ordered& out, const training::LearningCurve& curve, const Level& level) {
  std::vector<bool> reached, failed;
  for (const auto& point : curve.points) {
    reached.push_back(reaches(point, level));
    failed.push_back(!reached.back());
  }
  const CusumLimits limits = cusum_limits({});
  const Cusum sums = cusum(failed, limits);
  out["level"] = {{"at_least", known_or_null(level.at_least)},
                  {"at_most", known_or_null(level.at_most)},
                  {"in_a_row", level.in_a_row},
                  {"source", level.source}};
  out["attempts_to_level"] = known_or_null(attempts_to_level(reached, level.in_a_row));
  out["cusum"] = {{"sum", sums.sum},
                  {"h0", limits.h0},
                  {"h1", limits.h1},
                  {"accepted", known_or_null(sums.accepted)},
                  {"alarmed", known_or_null(sums.alarmed)}};
}

}  // namespace

Level level_of(const Gate& gate) { return {gate.at_least, gate.at_most, gate.in_a_row, "curriculum"}; }

std::optional<Level> level_of_specialists(const training::Store& store, const std::string& scene,
                                          const training::RunMetric& metric) {
  if (metric.better != "low" && metric.better != "high") return std::nullopt;
  std::vector<double> values;
  for (const training::Person& p : store.persons()) {
    if (p.role != "specialist") continue;
    for (const training::LearningCurve& c : store.curves(p.pseudonym, scene))
      if (c.metric.id == metric.id && c.metric.hand == metric.hand)
        for (const auto& point : c.points)
          if (point.done) values.push_back(point.value);
  }
  if (values.size() < fewest_expert_attempts) return std::nullopt;
  const double median = moving_median(values, values.size()).back();
  Level out;
  (metric.better == "low" ? out.at_most : out.at_least) = median;
  out.in_a_row = expert_in_a_row, out.source = "specialists";
  return out;
}

Ordered curve_json(const training::LearningCurve& c, const std::optional<Level>& level) {
  Ordered points = Ordered::array();
  for (const auto& p : c.points)
    points.push_back(
        {{"uuid", p.uuid}, {"began_ms", p.began_ms}, {"mode", p.mode}, {"done", p.done}, {"value", p.value}});
  Ordered out{{"metric", c.metric.id},      {"hand", c.metric.hand},     {"text", c.metric.text},
              {"unit", c.metric.unit},      {"better", c.metric.better}, {"digits", c.metric.digits},
              {"points", std::move(points)}};
  if (level) add_level(out, c, *level);
  return out;
}

}  // namespace insula::gateway
