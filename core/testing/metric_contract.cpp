// SPDX-License-Identifier: GPL-3.0-or-later
// Contract of metrics.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cmath>
#include <set>

#include "core/testing/contracts.h"
#include "core/testing/example.h"
#include "core/testing/findings.h"

namespace insula::test {
namespace {

std::string written(const std::vector<MetricValue>& values) {
  std::string out;
  for (const MetricValue& v : values)
    out += v.known ? fmt::format("{} {} {}\n", v.id, hand_name(v.hand), v.value)
                   : fmt::format("{} {} unknown\n", v.id, hand_name(v.hand));
  return out;
}

void check_values(Findings& findings, const std::vector<MetricValue>& values) {
  std::set<std::pair<std::string, int>> ids;
  for (const MetricValue& v : values) {
    findings.expect(ids.insert({v.id, v.hand}).second, "two metrics have one id", v.id);
    findings.expect(std::isfinite(v.value), "a known value is not finite", v.id);
    findings.expect(!v.text.empty() && !v.source.empty(), "a metric has no text or no source", v.id);
  }
}

}  // namespace

void check_metric(const std::filesystem::path& scene, const std::string& element) {
  auto s = load(scene);
  ASSERT_TRUE(s);
  Findings findings("<" + element + ">");
  Exercise* exercise = s->exercise();
  if (!findings.expect(exercise, "its example has no <exercise>")) return;
  std::vector<MetricSet*> sets;
  for (MetricSet* set : exercise->children_of<MetricSet>())
    if (set->element == element) sets.push_back(set);
  if (!findings.expect(!sets.empty(), "its example holds none of it")) return;
  for (const MetricSet* set : sets) findings.expect(!set->metrics().empty(), "it declares no metric");

  const std::string start = written(exercise->metrics());
  const std::uint64_t state = s->state_hash();
  exercise->metrics();
  findings.expect(s->state_hash() == state, "evaluate() changes the simulation's state");
  std::vector<std::string> first;
  for (int i = 0; i < 90; ++i) {
    run_script(*s, 1);
    const auto values = exercise->metrics();
    check_values(findings, values);
    first.push_back(written(values));
    findings.expect(written(exercise->metrics()) == first.back(), "evaluate() twice gives other values");
  }
  findings.expect(first.back() != start, "its example changes none of its values");
  s->reset();
  findings.expect(written(exercise->metrics()) == start, "reset() leaves something of the run");
  for (std::size_t i = 0; i < first.size(); ++i) {
    run_script(*s, 1);
    // Not evaluated in between: the values are a function of the reports alone.
    if (i % 30 == 29)
      findings.expect(written(exercise->metrics()) == first[i],
                      "the same run gives other values after reset() or with fewer calls of evaluate()");
  }
}

}  // namespace insula::test
