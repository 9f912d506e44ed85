// SPDX-License-Identifier: GPL-3.0-or-later
// Progress: what counts, rows that break, windows, order, repetitions, lapses, warm-ups, and the same answer for any
// order of attempts.
#include "training/curriculum/evaluate.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <random>

#include "training/curriculum/days.h"

namespace insula {
namespace {

constexpr std::int64_t hour = 3'600'000;
constexpr std::chrono::minutes utc{0};

Gate goals(int in_a_row = 1, std::int64_t within_ms = 0) {
  Gate gate;
  gate.text = "All goals are reached";
  gate.in_a_row = in_a_row;
  gate.within_ms = within_ms;
  return gate;
}

Gate no_faults(std::vector<std::string> ids = {}) {
  Gate gate = goals();
  gate.kind = Gate::Kind::faults;
  gate.faults = std::move(ids);
  return gate;
}

Gate metric(std::optional<double> at_least, std::optional<double> at_most) {
  Gate gate = goals();
  gate.kind = Gate::Kind::metric;
  gate.metric = "path_length";
  gate.hand = "right";
  gate.at_least = at_least;
  gate.at_most = at_most;
  return gate;
}

Task task(const std::string& id, std::vector<Gate> gates, TaskMode mode = TaskMode::practice) {
  Task out;
  out.id = id;
  out.scene = id + ".xml";
  out.mode = mode;
  out.gates = std::move(gates);
  return out;
}

Curriculum of(std::vector<Task> tasks) {
  Curriculum out;
  out.modules.push_back({"m", "M", "", {}, true, std::move(tasks)});
  return out;
}

/// An attempt at the scene of a task, so many days after 1970-01-01 at eight o'clock.
Attempt attempt(const std::string& task, double day, bool done = true, const std::string& mode = "test") {
  Attempt out;
  out.scene = task + ".xml";
  out.began_ms = std::int64_t(day * double(day_ms)) + 8 * hour;
  out.mode = mode;
  out.done = done;
  return out;
}

std::int64_t at(double day, double hours = 12) {
  return std::int64_t(day * double(day_ms)) + std::int64_t(hours * hour);
}

/// The only task's progress, at noon of that day.
TaskProgress after(const Curriculum& curriculum, const std::vector<Attempt>& attempts, double day) {
  return evaluate(curriculum, attempts, at(day), utc).modules.at(0).tasks.at(0);
}

TEST(Satisfies, GoalsFaultsAndMetrics) {
  Attempt a = attempt("a", 1);
  EXPECT_TRUE(satisfies(a, goals()));
  a.faults = {{"torn", 2}, {"order", 0}};
  EXPECT_FALSE(satisfies(a, no_faults()));
  EXPECT_TRUE(satisfies(a, no_faults({"order", "other"})));
  EXPECT_FALSE(satisfies(a, no_faults({"torn"})));
  EXPECT_FALSE(satisfies(a, metric({}, 900))) << "an unknown value satisfies nothing";
  a.metrics[{"path_length", "left"}] = 10;
  EXPECT_FALSE(satisfies(a, metric({}, 900))) << "the value of the other hand";
  a.metrics[{"path_length", "right"}] = 900;
  EXPECT_TRUE(satisfies(a, metric({}, 900)));
  EXPECT_TRUE(satisfies(a, metric(900, 900)));
  EXPECT_FALSE(satisfies(a, metric(901, {})));
  a.metrics[{"path_length", "right"}] = std::nan("");
  EXPECT_FALSE(satisfies(a, metric({}, {})));
}

TEST(CountsFor, ModesGuidesAndSeeds) {
  Task practice = task("a", {goals()}), test = task("a", {goals()}, TaskMode::test);
  for (const char* mode : {"practice", "test", "demonstration", "", "Test"}) {
    const Attempt a = attempt("a", 1, true, mode);
    EXPECT_EQ(counts_for(a, practice), std::string(mode) == "practice" || std::string(mode) == "test") << mode;
    EXPECT_EQ(counts_for(a, test), std::string(mode) == "test") << mode;
  }
  practice.guide = false;
  Attempt a = attempt("a", 1, true, "practice");
  EXPECT_FALSE(counts_for(a, practice)) << "practice may have been guided";
  a.guided = false;
  EXPECT_TRUE(counts_for(a, practice));
  practice.seeds = {7, 8};
  EXPECT_FALSE(counts_for(a, practice)) << "the seed is not known";
  a.seed = 8;
  EXPECT_TRUE(counts_for(a, practice));
  a.seed = 9;
  EXPECT_FALSE(counts_for(a, practice));
  EXPECT_FALSE(counts_for(attempt("b", 1), test));
}

TEST(Evaluate, ARowIsBrokenByAFailure) {
  const Curriculum c = of({task("a", {goals(3)})});
  std::vector<Attempt> attempts{attempt("a", 1), attempt("a", 2), attempt("a", 3, false), attempt("a", 4)};
  TaskProgress p = after(c, attempts, 5);
  EXPECT_EQ(p.standing, Standing::open);
  EXPECT_EQ(p.gates.at(0).in_a_row, 1);
  EXPECT_EQ(p.gates.at(0).needed, 3);
  EXPECT_EQ(p.why.text, "Still needed: All goals are reached (1 of 3 in a row)");
  attempts.push_back(attempt("a", 5));
  attempts.push_back(attempt("a", 6));
  p = after(c, attempts, 7);
  EXPECT_EQ(p.standing, Standing::passed);
  EXPECT_EQ(p.attempts_to_level, 6);
  EXPECT_EQ(p.passed_ms, attempts.back().began_ms);
  EXPECT_TRUE(p.gates.at(0).met);
  attempts.push_back(attempt("a", 8, false));
  EXPECT_EQ(after(c, attempts, 9).standing, Standing::passed) << "without repetition what was passed stays so";
}

TEST(Evaluate, ARowMustLieWithinItsTime) {
  const Curriculum c = of({task("a", {goals(2, 7 * day_ms)})});
  EXPECT_EQ(after(c, {attempt("a", 1), attempt("a", 8)}, 9).standing, Standing::passed) << "seven days exactly";
  const TaskProgress p = after(c, {attempt("a", 1), attempt("a", 8.01)}, 9);
  EXPECT_EQ(p.standing, Standing::open);
  EXPECT_EQ(p.gates.at(0).in_a_row, 1);
  EXPECT_EQ(after(c, {attempt("a", 1)}, 9).gates.at(0).in_a_row, 0) << "too long ago to be of use";
}

TEST(Evaluate, AllGatesMustBeMetTogether) {
  const Curriculum c = of({task("a", {goals(), no_faults()})});
  Attempt first = attempt("a", 1, true), second = attempt("a", 2, false);
  first.faults["torn"] = 1;
  EXPECT_EQ(after(c, {first, second}, 3).standing, Standing::open) << "each gate was met once, but not both at once";
  EXPECT_EQ(after(c, {first, second, attempt("a", 3)}, 4).standing, Standing::passed);
}

TEST(Evaluate, HelpDoesNotCountForATest) {
  const Curriculum c = of({task("a", {goals()}, TaskMode::test)});
  EXPECT_EQ(after(c, {attempt("a", 1, true, "practice"), attempt("a", 2, true, "demonstration")}, 3).attempts, 0);
  EXPECT_EQ(after(c, {attempt("a", 1, true, "test")}, 3).standing, Standing::passed);
  EXPECT_EQ(after(c, {attempt("a", 9, true, "test")}, 3).attempts, 0) << "an attempt after now";
}

TEST(Evaluate, TasksOpenInOrder) {
  Curriculum c = of({task("a", {goals()}), task("b", {goals()})});
  std::vector<Attempt> attempts{attempt("b", 1)};
  Progress p = evaluate(c, attempts, at(2), utc);
  EXPECT_EQ(p.modules[0].tasks[1].standing, Standing::locked);
  EXPECT_EQ(p.modules[0].tasks[1].locked_by, std::vector<std::string>{"a"});
  EXPECT_EQ(p.modules[0].tasks[1].attempts, 0) << "what is done before a task opens does not count";
  EXPECT_EQ(p.next.task, "a");
  attempts.push_back(attempt("a", 2));
  p = evaluate(c, attempts, at(3), utc);
  EXPECT_EQ(p.modules[0].tasks[1].standing, Standing::open);
  EXPECT_EQ(p.next.task, "b");
  attempts.push_back(attempt("b", 3));
  p = evaluate(c, attempts, at(4), utc);
  EXPECT_TRUE(p.passed);
  EXPECT_EQ(p.modules[0].standing, Standing::passed);
  EXPECT_EQ(p.next.kind, Recommendation::Kind::nothing);
  c.modules[0].in_order = false;
  EXPECT_EQ(evaluate(c, std::vector<Attempt>{attempt("b", 1)}, at(2), utc).modules[0].tasks[1].standing,
            Standing::passed);
}

TEST(Evaluate, OneAttemptDoesNotPassWhatItOpens) {
  Task practice = task("a", {goals()}), test = task("b", {goals()}, TaskMode::test);
  test.scene = practice.scene;
  const Progress p = evaluate(of({practice, test}), std::vector<Attempt>{attempt("a", 1)}, at(2), utc);
  EXPECT_EQ(p.modules[0].tasks[0].standing, Standing::passed);
  EXPECT_EQ(p.modules[0].tasks[1].standing, Standing::open);
}

TEST(Evaluate, ModulesOpenWhenWhatTheyRequireIsPassed) {
  Curriculum c = of({task("a", {goals()})});
  c.modules.push_back({"n", "N", "", {"m", "no such module"}, true, {task("b", {goals()})}});
  std::vector<Attempt> attempts{attempt("a", 1)};
  Progress p = evaluate(c, {}, at(1), utc);
  EXPECT_EQ(p.modules[1].standing, Standing::locked);
  EXPECT_EQ(p.modules[1].locked_by, (std::vector<std::string>{"m", "no such module"}));
  p = evaluate(c, attempts, at(2), utc);
  EXPECT_EQ(p.modules[1].locked_by, std::vector<std::string>{"no such module"});
  c.modules[1].needs = {"m"};
  p = evaluate(c, attempts, at(2), utc);
  EXPECT_EQ(p.modules[1].standing, Standing::open);
  EXPECT_EQ(p.modules[1].tasks[0].why.text, "Still needed: All goals are reached");
}

class Repetitions : public testing::Test {
 protected:
  Curriculum curriculum(bool keep_on = false) {
    Task t = task("a", {goals(2)});
    t.repetition = Repetition{{1 * day_ms, 3 * day_ms}, 2 * day_ms, keep_on};
    return of({t});
  }
  std::vector<Attempt> passed_{attempt("a", 1), attempt("a", 1.1)};
};

TEST_F(Repetitions, AreDueFromTheBeginningOfTheDay) {
  const Curriculum c = curriculum();
  EXPECT_EQ(evaluate(c, passed_, at(1, 23.9), utc).modules[0].tasks[0].standing, Standing::passed);
  const TaskProgress p = evaluate(c, passed_, at(2, 0), utc).modules[0].tasks[0];
  EXPECT_EQ(p.standing, Standing::due);
  EXPECT_EQ(p.due_ms, at(2, 0));
  EXPECT_EQ(p.missed_ms, at(4, 0));
  EXPECT_EQ(p.why.text, "A repetition is due since 1970-01-03; it is missed on 1970-01-05");
  // Three hours east of UTC the second day begins at 21 h.
  EXPECT_EQ(evaluate(c, passed_, at(1, 21), std::chrono::hours{3}).modules[0].tasks[0].standing, Standing::due);
  EXPECT_EQ(evaluate(c, passed_, at(1, 20.9), std::chrono::hours{3}).modules[0].tasks[0].standing, Standing::passed);
}

TEST_F(Repetitions, GoOnFromEachSuccess) {
  auto attempts = passed_;
  attempts.push_back(attempt("a", 1.5));  // before it is due: it changes nothing
  attempts.push_back(attempt("a", 2));    // one success is enough, whatever the row is
  TaskProgress p = after(curriculum(), attempts, 3);
  EXPECT_EQ(p.standing, Standing::passed);
  EXPECT_EQ(p.repetitions, 1);
  EXPECT_EQ(p.due_ms, at(5, 0));
  attempts.push_back(attempt("a", 6));
  p = after(curriculum(), attempts, 100);
  EXPECT_EQ(p.standing, Standing::passed) << "the last repetition has been done";
  EXPECT_FALSE(p.due_ms);
  EXPECT_EQ(after(curriculum(true), attempts, 6).due_ms, at(9, 0)) << "or the last interval comes again";
}

TEST_F(Repetitions, LapseWhenTheyFail) {
  auto attempts = passed_;
  attempts.push_back(attempt("a", 2, false));
  TaskProgress p = after(curriculum(), attempts, 2);
  EXPECT_EQ(p.standing, Standing::lapsed);
  EXPECT_EQ(p.why.key, "repetition_failed");
  EXPECT_EQ(p.gates.at(0).in_a_row, 0);
  attempts.push_back(attempt("a", 3));
  EXPECT_EQ(after(curriculum(), attempts, 3).standing, Standing::lapsed) << "the whole row is needed again";
  attempts.push_back(attempt("a", 3.1));
  p = after(curriculum(), attempts, 3);
  EXPECT_EQ(p.standing, Standing::passed);
  EXPECT_EQ(p.due_ms, at(4, 0)) << "and the intervals begin again";
  EXPECT_EQ(p.attempts_to_level, 2) << "the first time counts";
}

TEST_F(Repetitions, LapseWhenTheyAreMissed) {
  EXPECT_EQ(evaluate(curriculum(), passed_, at(4, 0) - 1, utc).modules[0].tasks[0].standing, Standing::due);
  const TaskProgress p = evaluate(curriculum(), passed_, at(4, 0), utc).modules[0].tasks[0];
  EXPECT_EQ(p.standing, Standing::lapsed);
  EXPECT_EQ(p.why.text, "A repetition was missed on 1970-01-05. Still needed: All goals are reached (0 of 2 in a row)");
  auto attempts = passed_;
  attempts.push_back(attempt("a", 50));
  EXPECT_EQ(after(curriculum(), attempts, 51).gates.at(0).in_a_row, 1) << "it is the first of a new row";
}

TEST_F(Repetitions, ALapseLocksNothing) {
  Curriculum c = curriculum();
  c.modules.push_back({"n", "N", "", {"m"}, true, {task("b", {goals()})}});
  const Progress p = evaluate(c, passed_, at(40), utc);
  EXPECT_EQ(p.modules[0].standing, Standing::lapsed);
  EXPECT_EQ(p.modules[1].standing, Standing::open);
  EXPECT_EQ(p.next.task, "a") << "but it comes first";
}

TEST_F(Repetitions, AreRecommendedBeforeOpenTasks) {
  Curriculum c = curriculum();
  c.modules.push_back({"n", "N", "", {"m"}, true, {task("b", {goals()})}});
  EXPECT_EQ(evaluate(c, passed_, at(1), utc).next.task, "b");
  const Recommendation next = evaluate(c, passed_, at(2), utc).next;
  EXPECT_EQ(next.kind, Recommendation::Kind::repetition);
  EXPECT_EQ(next.task, "a");
}

class WarmUps : public testing::Test {
 protected:
  WarmUps() {
    curriculum_ = of({task("a", {goals()}), task("b", {goals()})});
    curriculum_.warm_ups = {{"a", "a.xml", "", 2}};
  }
  Recommendation next(const std::vector<Attempt>& attempts, double day, std::chrono::minutes offset = utc) {
    return evaluate(curriculum_, attempts, at(day), offset).next;
  }
  Curriculum curriculum_;
};

TEST_F(WarmUps, ComeBeforeTheFirstWorkOfADay) {
  EXPECT_EQ(next({}, 1).kind, Recommendation::Kind::task) << "nobody warms up with what was never passed";
  std::vector<Attempt> attempts{attempt("a", 1)};
  Recommendation r = next(attempts, 2);
  EXPECT_EQ(r.kind, Recommendation::Kind::warm_up);
  EXPECT_EQ(r.scene, "a.xml");
  EXPECT_EQ(r.why.text, "Warm up before the first work of the day: 2 of 2 left");
  attempts.push_back(attempt("a", 2, false, "practice"));
  EXPECT_EQ(next(attempts, 2).why.text, "Warm up before the first work of the day: 1 of 2 left");
  attempts.push_back(attempt("a", 2.01, true, "demonstration"));
  EXPECT_EQ(next(attempts, 2).kind, Recommendation::Kind::warm_up) << "watching is no warm-up";
  attempts.push_back(attempt("a", 2.02, true, "practice"));
  EXPECT_EQ(next(attempts, 2).task, "b");
  EXPECT_EQ(next(attempts, 3).kind, Recommendation::Kind::warm_up) << "another day";
}

TEST_F(WarmUps, AreLeftOutOnceTheWorkHasBegun) {
  EXPECT_EQ(next({attempt("a", 1), attempt("b", 2, false)}, 2).kind, Recommendation::Kind::task);
  EXPECT_EQ(next({attempt("a", 1), attempt("b", 2)}, 3).kind, Recommendation::Kind::nothing) << "nothing is left to do";
}

TEST_F(WarmUps, TheDayIsTheLocalOne) {
  const std::vector<Attempt> attempts{attempt("a", 1), attempt("b", 1.5, false)};  // the second one at 20 h
  EXPECT_EQ(evaluate(curriculum_, attempts, at(1, 23), utc).next.kind, Recommendation::Kind::task);
  EXPECT_EQ(evaluate(curriculum_, attempts, at(1, 23), std::chrono::hours{2}).next.kind, Recommendation::Kind::warm_up);
}

TEST_F(WarmUps, MayHaveASceneOfTheirOwn) {
  curriculum_.warm_ups = {{"", "w.xml", "", 1}, {"", "w.xml", "", 1}};
  EXPECT_EQ(next({}, 1).scene, "w.xml");
  EXPECT_EQ(next({attempt("w", 1)}, 1).kind, Recommendation::Kind::warm_up) << "the second of two";
  EXPECT_EQ(next({attempt("w", 1), attempt("w", 1.1)}, 1).task, "a");
}

TEST(Evaluate, SeedsComeOneAfterTheOther) {
  Task t = task("a", {goals(3)});
  t.seeds = {5, 6};
  const Curriculum c = of({t});
  EXPECT_EQ(after(c, {}, 1).next_seed, 5);
  Attempt first = attempt("a", 1);
  first.seed = 5;
  EXPECT_EQ(after(c, {first}, 2).next_seed, 6);
  EXPECT_EQ(evaluate(c, std::vector<Attempt>{first}, at(2), utc).next.seed, 6);
}

// --- the same answer, and an answer to everything -------------------------------------------------------------------

/// All that a progress says, in one text.
std::string said(const Progress& p) {
  std::string out = p.next.task + "|" + p.next.scene + "|" + p.next.why.text + (p.passed ? "|passed" : "");
  for (const ModuleProgress& m : p.modules) {
    out += "\n" + m.id + " " + std::string(standing_name(m.standing));
    for (const TaskProgress& t : m.tasks) {
      out += "\n" + t.id + " " + t.why.text + " " + std::to_string(t.attempts) + " " + std::to_string(t.repetitions) +
             " " + std::to_string(t.due_ms.value_or(-1));
      for (const GateProgress& g : t.gates) out += " " + std::to_string(g.in_a_row);
    }
  }
  return out;
}

TEST(Evaluate, AttemptsMayComeInAnyOrder) {
  Task a = task("a", {goals(2, 5 * day_ms), metric({}, 900)}), b = task("b", {no_faults()}, TaskMode::test);
  a.repetition = Repetition{{day_ms, 3 * day_ms}, 4 * day_ms, true};
  Curriculum c = of({a, b});
  c.warm_ups = {{"a", "a.xml", "", 1}};
  std::mt19937 random(7);
  std::vector<Attempt> attempts;
  for (int i = 0; i < 60; ++i) {
    attempts.push_back(attempt(random() % 2 ? "a" : "b", double(random() % 40), random() % 4 > 0));
    attempts.back().metrics[{"path_length", "right"}] = 600 + double(random() % 400);
    if (random() % 3 == 0) attempts.back().faults["torn"] = 1;
  }
  const std::string first = said(evaluate(c, attempts, at(40), utc));
  for (int i = 0; i < 20; ++i) {
    std::shuffle(attempts.begin(), attempts.end(), random);
    EXPECT_EQ(said(evaluate(c, attempts, at(40), utc)), first);
  }
}

TEST(Evaluate, HasAnAnswerToEverything) {
  using Limits = std::numeric_limits<std::int64_t>;
  EXPECT_TRUE(evaluate({}, {}, 0, utc).passed);
  Task odd = task("a", {});
  odd.gates.push_back(goals(-3, -5));
  odd.repetition = Repetition{{Limits::max(), Limits::min()}, Limits::max(), true};
  Curriculum c = of({odd, task("", {})});
  c.modules.push_back({"m", "", "", {"m"}, true, {}});
  c.warm_ups = {{"none", "", "", -1}, {"", "", "", 1 << 30}};
  std::vector<Attempt> attempts{attempt("a", 1), attempt("a", 2), Attempt{}};
  attempts.push_back(attempt("a", 1));
  attempts.back().began_ms = Limits::max();
  attempts.push_back(attempt("a", 1));
  attempts.back().began_ms = Limits::min();
  attempts[0].faults["x"] = std::numeric_limits<int>::max();
  attempts[1].faults = {{"x", std::numeric_limits<int>::max()}, {"y", std::numeric_limits<int>::max()}};
  for (const std::int64_t now : {Limits::min(), std::int64_t(0), at(3), Limits::max()})
    for (const int minutes : {std::numeric_limits<int>::min(), 0, std::numeric_limits<int>::max()})
      EXPECT_FALSE(said(evaluate(c, attempts, now, std::chrono::minutes{minutes})).empty());
}

}  // namespace
}  // namespace insula
