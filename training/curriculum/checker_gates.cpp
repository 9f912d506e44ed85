// SPDX-License-Identifier: GPL-3.0-or-later
// Gates: their limits in the units of the metrics, and the figures of bands.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "core/base/text.h"
#include "core/params/param.h"
#include "training/curriculum/checker.h"

namespace insula {
namespace {

std::string with_unit(double value, const std::string& unit) {
  return fmt::format("{:.6g}{}{}", value, unit.empty() ? "" : " ", unit);
}

/// "at least 2 mm and at most 3 mm".
std::string limits_text(const Gate& gate) {
  std::vector<std::string> parts;
  if (gate.at_least) parts.push_back("at least " + with_unit(*gate.at_least, gate.unit));
  if (gate.at_most) parts.push_back("at most " + with_unit(*gate.at_most, gate.unit));
  return joined(parts, " and ");
}

template <class Fact>
std::vector<std::string> ids_of(const std::vector<Fact>& facts) {
  std::vector<std::string> out;
  for (const Fact& f : facts) out.push_back(f.id);
  return out;
}

/// The side of a figure of a group that shows less skill is the limit.
void take_figure(double low, double high, Better better, Gate& gate) {
  if (better != Better::low) gate.at_least = low;
  if (better != Better::high) gate.at_most = high;
}

}  // namespace

Gate CurriculumChecker::gate(const GateElement& from, const SceneFacts* facts, const std::filesystem::path& scene) {
  Gate out;
  out.in_a_row = from.in_a_row();
  out.within_ms = from.within.given() ? std::llround(1000 * from.within()) : 0;
  if (from.within.given() && from.in_a_row() == 1)
    diagnostics_.warning(from.within.pos(), "within: it has no effect on one attempt; give in_a_row too");
  if (const auto* faults = dynamic_cast<const FaultsGate*>(&from)) {
    faults_gate(*faults, facts, out);
  } else if (const auto* metric = dynamic_cast<const MetricGate*>(&from)) {
    metric_gate(*metric, facts, scene, out);
  } else {
    out.text = "All goals are reached";
  }
  return out;
}

void CurriculumChecker::faults_gate(const FaultsGate& from, const SceneFacts* facts, Gate& gate) {
  gate.kind = Gate::Kind::faults;
  gate.most_faults = from.at_most();
  for (const std::string_view word : split_blanks(from.faults())) {
    const std::string id(word);
    gate.faults.push_back(id);
    if (!facts) continue;
    const auto known =
        std::find_if(facts->faults.begin(), facts->faults.end(), [&](const auto& f) { return f.id == id; });
    if (known != facts->faults.end()) gate.fault_texts.push_back(known->text);
    else error(from, from.faults, "the exercise has no fault " + in_quotes(id) + suggestion(id, ids_of(facts->faults)));
  }
  gate.text = gate.most_faults == 0 ? "No faults" : fmt::format("At most {} faults", gate.most_faults);
  if (!gate.faults.empty()) gate.text += " of these: " + joined(gate.fault_texts);
}

void CurriculumChecker::metric_gate(const MetricGate& from, const SceneFacts* facts, const std::filesystem::path& scene,
                                    Gate& gate) {
  gate.kind = Gate::Kind::metric;
  gate.metric = from.metric();
  const bool limits = from.at_most.given() || from.at_least.given(), group = !from.group().empty();
  if (limits && group) error(from, from.group, "a gate has either limits or a group, not both");
  if (!limits && !group && !reader_.failed(from))
    reader_.report(from, from.pos, "<gate_metric> needs a limit (at_most, at_least) or a group of bands");
  for (const ParamBase* p : {static_cast<const ParamBase*>(&from.level), static_cast<const ParamBase*>(&from.bands)})
    if (p->given() && !group) error(from, *p, "it needs a group of the bands, which is not given");
  const MetricFact* metric = facts && from.metric.given() ? this->metric(from, *facts, gate.hand) : nullptr;
  if (!metric) return;
  gate.unit = metric->unit;
  gate.metric_text = metric->text;
  gate.at_least = limit(from, from.at_least, *metric);
  gate.at_most = limit(from, from.at_most, *metric);
  if (gate.at_least && gate.at_most && *gate.at_least > *gate.at_most)
    error(from, from.at_least, "it is above at_most, so nothing satisfies the gate");
  if (group && !limits) band(from, *facts, *metric, scene, gate);
  gate.group = from.group();
  gate.text = metric->text + (metric->of == Of::each_hand ? ", " + gate.hand + " hand" : "") + ": " +
              limits_text(gate) + (group ? ", from the group " + in_quotes(gate.group) : "");
}

const MetricFact* CurriculumChecker::metric(const MetricGate& from, const SceneFacts& facts, std::string& hand) {
  const auto found = std::find_if(facts.metrics.begin(), facts.metrics.end(),
                                  [&](const MetricFact& m) { return m.id == from.metric(); });
  if (found == facts.metrics.end()) {
    error(from, from.metric,
          "the exercise has no metric " + in_quotes(from.metric()) + suggestion(from.metric(), ids_of(facts.metrics)));
    return nullptr;
  }
  hand = from.hand();
  if (found->of == Of::both_hands) {
    if (hand != "both" && !hand.empty())
      error(from, from.hand, in_quotes(found->id) + " is a metric of both hands together");
    hand = "both";
  } else if (hand == "both" || !from.hand.given()) {
    error(from, from.hand, in_quotes(found->id) + " is a metric of each hand; say which, left or right");
  }
  return &*found;
}

std::optional<double> CurriculumChecker::limit(const MetricGate& from, const Param<MetricLimit>& param,
                                               const MetricFact& metric) {
  if (!param.given()) return std::nullopt;
  std::string why;
  const auto value = parse_quantity(param.text(), metric.units, metric.quantity, why);
  if (!value) error(from, param, why);
  return value ? std::optional(*value * metric.scale) : std::nullopt;
}

void CurriculumChecker::band(const MetricGate& from, const SceneFacts& facts, const MetricFact& metric,
                             const std::filesystem::path& scene, Gate& gate) {
  if (reader_.failed(from)) return;
  std::filesystem::path file = as_named(from, from.bands);
  if (from.bands.empty()) file = std::filesystem::path(scene).replace_filename(scene.stem().string() + "_bands.json");
  std::string why;
  const auto band = sources_.band(file, from.group(), facts, metric, gate.hand, why);
  if (!band) return error(from, from.group, why);
  if (from.level.is("middle_half")) return take_figure(band->low, band->high, metric.better, gate);
  if (metric.better == Better::none)
    return error(from, from.level, in_quotes(metric.id) + " has no better side; only middle_half fits it");
  if (from.level.is("median")) return take_figure(band->median, band->median, metric.better, gate);
  if (!band->pass_mark) return error(from, from.level, "the bands have no pass mark; insula bands --pass makes one");
  take_figure(*band->pass_mark, *band->pass_mark, metric.better, gate);
}

}  // namespace insula
