// SPDX-License-Identifier: GPL-3.0-or-later
// How far a person has come in a curriculum, from that person's attempts alone.
//
// Attempts are gone through in order of time. An attempt counts for each task that is open at that moment and whose
// scene, mode, guide and seeds it fits. A task is passed when all of its gates are met by the attempts that count. It
// stays passed until a repetition fails or is missed. Then it has lapsed, and it is passed again by new attempts.
// A module that was passed once keeps open what needs it.
//
// The result is a function of the arguments: there is no clock inside, and attempts may come in any order. It has a
// value for every argument: attempts after `now_ms`, of other scenes and in unknown modes are left out.
#pragma once
#include <chrono>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "training/curriculum/attempt.h"
#include "training/curriculum/curriculum.h"

namespace insula {

enum class Standing {
  locked,  ///< something else must be passed first
  open,    ///< to be worked on
  passed,
  due,     ///< passed, and a repetition is due
  lapsed,  ///< was passed; a repetition has failed or was missed, so it is open again
};
std::string_view standing_name(Standing standing);  ///< "locked", "open", ...

struct GateProgress {
  std::string text;  ///< the condition in words
  int in_a_row = 0;  ///< the last attempts that satisfy it, at most `needed`
  int needed = 1;
  bool met = false;  ///< at the moment of passing, or by the attempts until now
};

/// Why something is as it is: a key for programs, and a sentence for people.
struct Reason {
  std::string key, text;
};

struct TaskProgress {
  std::string id;
  Standing standing = Standing::open;
  std::vector<std::string> locked_by;     ///< ids of the modules and tasks that must be passed before
  std::vector<GateProgress> gates;        ///< in the order of the task
  int attempts = 0;                       ///< those that counted
  std::vector<std::string> runs;          ///< Attempt::run of those behind `gates`: since the beginning or a lapse
  std::optional<int> attempts_to_level;   ///< those that counted until the task was passed for the first time
  std::optional<std::int64_t> passed_ms;  ///< beginning of the attempt that passed it last
  int repetitions = 0;                    ///< that have succeeded since then
  std::optional<std::int64_t> due_ms;     ///< when the next repetition is or was due
  std::optional<std::int64_t> missed_ms;  ///< when that repetition counts as missed
  std::optional<int> next_seed;           ///< of the complications of the next attempt; none: any
  Reason why;
};

struct ModuleProgress {
  std::string id;
  /// Locked; lapsed or due if a task is; passed if all tasks are; else open.
  Standing standing = Standing::open;
  std::vector<std::string> locked_by;  ///< ids of modules
  std::vector<TaskProgress> tasks;     ///< in the order of the module
};

/// What to do next.
struct Recommendation {
  enum class Kind { nothing, warm_up, repetition, task };
  Kind kind = Kind::nothing;
  std::string task;   ///< id; empty for a warm-up with a scene of its own
  std::string scene;  ///< as scene_key() names it
  TaskMode mode = TaskMode::practice;
  bool guide = true;
  std::optional<int> seed;
  Reason why;
  int left = 0;  ///< attempts of a warm-up that are still to be made
};

struct Progress {
  std::vector<ModuleProgress> modules;  ///< in the order of the curriculum
  bool passed = false;                  ///< all tasks stand as passed or due
  Recommendation next;
};

/// Whether one attempt satisfies the condition of a gate, whatever others did.
bool satisfies(const Attempt& attempt, const Gate& gate);
/// Whether an attempt counts for a task that is open: its scene, mode, guide and seed fit.
bool counts_for(const Attempt& attempt, const Task& task);

/// now_ms: UTC since 1970-01-01. utc_offset: local time less UTC. It is taken as constant, so a change to summer time
/// moves the beginning of earlier days by an hour.
Progress evaluate(const Curriculum& curriculum, std::span<const Attempt> attempts, std::int64_t now_ms,
                  std::chrono::minutes utc_offset);

}  // namespace insula
