// SPDX-License-Identifier: GPL-3.0-or-later
// What the training store keeps: persons and their runs. Times are milliseconds since 1970, UTC.
#pragma once
#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace insula::training {

inline constexpr std::array<std::string_view, 6> roles{"student",    "resident",   "fellow",
                                                       "specialist", "instructor", "other"};
inline constexpr std::array<std::string_view, 4> handedness_names{"right", "left", "both", "not said"};

/// Somebody who trains, under a pseudonym of his own.
struct Person {
  std::int64_t id = 0;
  std::string pseudonym;                ///< 1 to 40 characters, equal in upper and lower case
  std::string role = "other";           ///< one of `roles`
  std::string handedness = "not said";  ///< one of `handedness_names`
  int year = 0;                         ///< of training, from 1; 0: not said
  std::int64_t created_ms = 0;
};

/// Throws InputError that says what is wrong with the fields of a person.
void check(const Person& person);

struct RunMetric {
  std::string id, hand;  ///< hand: "left", "right" or "both"
  double value = 0;      ///< in `unit`
  std::string text, unit, better;
  int digits = 2;
};

struct RunFault {
  std::string id, text;
  int count = 0;
};

/// One pass through an exercise.
struct Run {
  std::int64_t id = 0;
  std::string uuid;    ///< of this run; a second one with the same is not added
  std::string person;  ///< pseudonym; empty: a guest
  std::string scene;   ///< file, relative to the project's folder if it is below it
  std::string title;   ///< of the exercise
  std::string mode;    ///< "practice", "test" or "demonstration"
  std::int64_t began_ms = 0;
  double duration_s = 0;  ///< simulated
  std::string state;      ///< "done", "failed" or "running": left before its end
  int goals = 0, goals_done = 0, faults = 0;
  double step_rate_hz = 0;
  std::optional<std::int64_t> seed;  ///< of the complications; none: the scene has none
  bool guided = false;               ///< targets were shown to the hands
  std::string report, recording;     ///< files; empty: none
  std::string version;               ///< of the program that ran it; empty: not known
  std::vector<RunMetric> metrics;
  std::vector<RunFault> fault_counts;

  bool done() const { return state == "done"; }
  bool is_attempt() const { return !person.empty() && mode != "demonstration"; }  ///< of a person
};

/// Of one person in one exercise.
struct ExerciseHistory {
  std::string scene, title;
  int runs = 0;
  std::optional<Run> last, best;  ///< without metrics and faults by name. best: done, fewest faults, then fastest
};

/// A metric over the runs of a person in an exercise.
struct LearningCurve {
  struct Point {
    std::string uuid;
    std::int64_t began_ms = 0;
    std::string mode;
    bool done = false;
    double value = 0;
  };
  RunMetric metric;           ///< its declaration; the value is unused
  std::vector<Point> points;  ///< in order of time
};

}  // namespace insula::training
