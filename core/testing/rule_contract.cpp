// SPDX-License-Identifier: GPL-3.0-or-later
// Contract of exercise rules.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <fstream>
#include <set>
#include <sstream>

#include "core/testing/contracts.h"
#include "core/testing/example.h"
#include "core/testing/findings.h"

namespace insula::test {
namespace {

/// All output of the rules, as text.
std::string written(const ExerciseLog& log) {
  std::string out;
  for (const GoalState& g : log.goals()) out += fmt::format("goal {} {} {}\n", g.id, g.done, g.time);
  for (const FaultState& f : log.faults()) out += fmt::format("fault {} {} {}\n", f.id, f.count, f.last_time);
  for (const TimerState& t : log.timers())
    out += fmt::format("timer {} {} {} {}\n", t.id, t.elapsed, t.running, t.longest);
  for (const MeasureState& m : log.measures())
    out += fmt::format("measure {} {} {} {}\n", m.id, m.known, m.value, m.good);
  return out + fmt::format("end {} {}\n", int(log.state()), log.end_time());
}

void check_log(Findings& findings, const ExerciseLog& log) {
  std::set<std::string> ids;
  const auto once = [&](const std::string& id) {
    findings.expect(!id.empty() && ids.insert(id).second, "two goals or faults have one id", "\"" + id + "\"");
  };
  for (const GoalState& g : log.goals()) once(g.id);
  for (const FaultState& f : log.faults()) once(f.id);
}

/// The scene's text without its exercise.
std::string without_exercise(std::string text) {
  const std::size_t from = text.find("<exercise"), to = text.find("</exercise>");
  return text.erase(from, to + 11 - from);
}

}  // namespace

void check_exercise_rule(const std::filesystem::path& scene, const std::string& element) {
  std::ifstream in(scene);
  std::stringstream buffer;
  buffer << in.rdbuf();
  const std::string text = buffer.str();
  const std::size_t from = text.find("<exercise");
  Findings findings("<" + element + ">");
  if (!findings.expect(from != std::string::npos && text.find("</exercise>") != std::string::npos,
                       "its example has no <exercise>"))
    return;
  findings.expect(text.find("<" + element, from) != std::string::npos, "its example holds none of it");
  auto with = load(scene), without = load_text(without_exercise(text), scene);
  ASSERT_TRUE(with && without);
  ASSERT_TRUE(with->exercise());
  ASSERT_FALSE(without->exercise());
  std::vector<std::string> first;
  const std::string start = written(with->exercise()->log());
  for (int i = 0; i < 90; ++i) {
    run_script(*with, 1);
    run_script(*without, 1);
    first.push_back(written(with->exercise()->log()));
    check_log(findings, with->exercise()->log());
    // Document positions change, and row ids with them. The state must not.
    if (!findings.expect(with->state_hash() == without->state_hash(),
                         "the exercise changes the simulation's state: rules only read", fmt::format("step {}", i)))
      return;
  }
  with->reset();
  findings.expect(written(with->exercise()->log()) == start, "reset() leaves something in the log",
                  written(with->exercise()->log()));
  for (std::size_t i = 0; i < first.size(); ++i) {
    run_script(*with, 1);
    if (!findings.expect(written(with->exercise()->log()) == first[i],
                         "after reset() the same run is judged otherwise: reset() must clear what the rule remembers",
                         fmt::format("step {}", i)))
      return;
  }
}

}  // namespace insula::test
