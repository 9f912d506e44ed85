// SPDX-License-Identifier: GPL-3.0-or-later
// A curriculum as plain data: modules of tasks with gates. load_curriculum() of training/curriculum/loader.h makes it
// from a file, and evaluate() of training/curriculum/evaluate.h says how far a person has come in it.
#pragma once
#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

namespace insula {

/// A condition on attempts. It is met when the last `in_a_row` attempts satisfy it, all begun within `within_ms`.
struct Gate {
  enum class Kind {
    goals,   ///< the attempt is done
    faults,  ///< at most `most_faults` of the faults
    metric,  ///< a metric from `at_least` to `at_most`
  };
  Kind kind = Kind::goals;
  std::vector<std::string> faults = {};       ///< ids of those that count; empty: all
  std::vector<std::string> fault_texts = {};  ///< of the same, for persons
  int most_faults = 0;
  std::string metric = {}, hand = {};                 ///< id and "left", "right" or "both"
  std::optional<double> at_least = {}, at_most = {};  ///< in `unit`; none: open on that side
  std::string unit = {};                              ///< in which the exercise shows the metric; may be empty
  std::string metric_text = {}, group = {};  ///< what the metric is; whose figures the limits are, if a group's
  std::string text = {};                     ///< the condition in words
  int in_a_row = 1;
  std::int64_t within_ms = 0;  ///< from the beginning of the first to that of the last attempt; 0: any time
};

/// Spaced repetition after a task has been passed. Times in milliseconds.
struct Repetition {
  /// From one success to when the next repetition is due. An interval of whole days is due from the beginning of its
  /// day.
  std::vector<std::int64_t> after_ms;
  std::int64_t grace_ms = 0;  ///< from due to missed
  bool keep_on = false;       ///< the last interval comes again and again
};

enum class TaskMode {
  practice,  ///< attempts in practice and in a test count
  test,      ///< attempts in a test count, which are without help
};

struct Task {
  std::string id, title, text;
  std::string scene;  ///< as scene_key() names it
  TaskMode mode = TaskMode::practice;
  bool guide = true;            ///< guided practice counts
  std::vector<int> seeds = {};  ///< of the complications, one attempt after the other; empty: any
  std::vector<Gate> gates;
  std::optional<Repetition> repetition = {};
};

struct Module {
  std::string id, title, text;
  std::vector<std::string> needs = {};  ///< ids of modules that must have been passed before
  bool in_order = true;                 ///< a task opens when those before it have been passed
  std::vector<Task> tasks;
};

/// What comes before the first work of a day.
struct WarmUp {
  std::string task = {};  ///< id of a task, which must have been passed once; empty: `scene`
  std::string scene;      ///< as scene_key() names it
  std::string text = {};
  int times = 1;
};

struct Curriculum {
  std::string title, text;
  std::vector<Module> modules;
  std::vector<WarmUp> warm_ups = {};
  unsigned long long content_hash = 0;  ///< FNV-1a over the file and what it includes; 0: not from a file
};

/// Name of a scene in curricula and attempts: its path from the folder that holds `meshes`, with "/" between folders
/// ("scenes/training/3_clipping.xml"). A scene outside of such a folder keeps its file name alone.
std::string scene_key(const std::filesystem::path& scene_file);

/// The task of that id; null if there is none.
const Task* find_task(const Curriculum& curriculum, const std::string& id);

}  // namespace insula
