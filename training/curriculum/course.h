// SPDX-License-Identifier: GPL-3.0-or-later
// A person's way through a curriculum, attempt after attempt. The working parts of evaluate().
#pragma once
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "training/curriculum/evaluate.h"

namespace insula {

/// Where a person stands in one task at one moment.
struct TaskState {
  enum class Lapse { none, failed, missed };
  const Task* task = nullptr;
  std::vector<const Attempt*> counted;  ///< since the beginning or the last lapse
  int attempts = 0;
  std::optional<int> attempts_to_level = {};
  bool held = false;  ///< passed, and not lapsed since
  Lapse lapse = Lapse::none;
  std::int64_t lapsed_ms = 0;
  std::optional<std::int64_t> passed_ms = {};
  int repetitions = 0;
  std::optional<std::int64_t> due_ms = {}, missed_ms = {};

  bool ever_passed() const { return attempts_to_level.has_value(); }
};

/// Where a person stands in all tasks. The curriculum and the attempts must outlive it.
class Course {
 public:
  Course(const Curriculum& curriculum, std::int64_t offset_ms);

  /// Goes on to the moment of an attempt, and lets it count. Moments must not go back.
  void add(const Attempt& attempt);
  /// Goes on to a moment: repetitions that were missed until then lapse.
  void advance(std::int64_t ms);

  /// Tasks of a module, in its order.
  const std::vector<TaskState>& tasks(std::size_t module) const { return states_[module]; }
  /// The state of the task of that id; null if there is none.
  const TaskState* find(const std::string& task) const;
  /// Ids of the modules that must be passed before this one.
  std::vector<std::string> module_locks(std::size_t module) const;
  /// Ids of the modules and tasks that must be passed before this task.
  std::vector<std::string> task_locks(std::size_t module, std::size_t task) const;

 private:
  bool module_ever_passed(const std::string& id) const;
  void take(TaskState& state, const Attempt& attempt) const;
  void take_repetition(TaskState& state, const Attempt& attempt) const;
  void schedule(TaskState& state, std::int64_t from_ms) const;

  const Curriculum& curriculum_;
  std::int64_t offset_ms_;
  std::vector<std::vector<TaskState>> states_;
};

/// Attempts at the end of a list that satisfy a gate one after the other and lie within its time before `until_ms`; at
/// most `in_a_row` of the gate.
int run_length(const std::vector<const Attempt*>& attempts, const Gate& gate, std::int64_t until_ms);

/// What to do next. attempts: in order of time, all of them before now_ms.
Recommendation recommend(const Curriculum& curriculum, const Course& course, const Progress& progress,
                         std::span<const Attempt* const> attempts, std::int64_t now_ms, std::int64_t offset_ms);

}  // namespace insula
