// SPDX-License-Identifier: GPL-3.0-or-later
// What to do next: the warm-up of the day, then repetitions, then open tasks in order.
#include <fmt/format.h>

#include <algorithm>
#include <map>

#include "training/curriculum/course.h"
#include "training/curriculum/days.h"

namespace insula {
namespace {

/// Of a module, due can hide an open task, and the reverse. So each task is asked.
Recommendation next_task(const Curriculum& curriculum, const Progress& progress) {
  const TaskProgress *due = nullptr, *open = nullptr;
  for (const ModuleProgress& module : progress.modules)
    for (const TaskProgress& task : module.tasks) {
      if (task.standing == Standing::due && (!due || *task.due_ms < *due->due_ms)) due = &task;
      if ((task.standing == Standing::open || task.standing == Standing::lapsed) && !open) open = &task;
    }
  const TaskProgress* chosen = due ? due : open;
  if (!chosen) return {};
  const Task* task = find_task(curriculum, chosen->id);
  if (!task) return {};
  return {due ? Recommendation::Kind::repetition : Recommendation::Kind::task,
          task->id,
          task->scene,
          task->mode,
          task->guide && task->mode == TaskMode::practice,
          chosen->next_seed,
          chosen->why};
}

/// Attempts of today at each scene.
std::map<std::string, int> today(std::span<const Attempt* const> attempts, std::int64_t now_ms,
                                 std::int64_t offset_ms) {
  std::map<std::string, int> out;
  for (const Attempt* a : attempts)
    if (local_day(a->began_ms, offset_ms) == local_day(now_ms, offset_ms)) ++out[a->scene];
  return out;
}

/// The warm-ups of this person, with what each lacks today. None once something else was done today.
std::vector<std::pair<const WarmUp*, int>> lacking(const Curriculum& curriculum, const Course& course,
                                                   std::map<std::string, int> done) {
  std::vector<std::pair<const WarmUp*, int>> out;
  std::vector<std::string> scenes;
  for (const WarmUp& warm_up : curriculum.warm_ups) {
    const TaskState* state = warm_up.task.empty() ? nullptr : course.find(warm_up.task);
    if (!warm_up.task.empty() && (!state || !state->ever_passed())) continue;
    int& left = done[warm_up.scene];
    const int used = std::min(left, warm_up.times);
    left -= used;
    out.emplace_back(&warm_up, warm_up.times - used);
    scenes.push_back(warm_up.scene);
  }
  for (const auto& [scene, count] : done)
    if (std::find(scenes.begin(), scenes.end(), scene) == scenes.end()) return {};
  return out;
}

}  // namespace

Recommendation recommend(const Curriculum& curriculum, const Course& course, const Progress& progress,
                         std::span<const Attempt* const> attempts, std::int64_t now_ms, std::int64_t offset_ms) {
  Recommendation next = next_task(curriculum, progress);
  if (next.kind == Recommendation::Kind::nothing) {
    next.why = {"nothing",
                progress.passed ? "Everything has been passed, and no repetition is due" : "Nothing is open"};
    return next;
  }
  for (const auto& [warm_up, left] : lacking(curriculum, course, today(attempts, now_ms, offset_ms))) {
    if (left == 0) continue;
    const Task* task = warm_up->task.empty() ? nullptr : find_task(curriculum, warm_up->task);
    return {Recommendation::Kind::warm_up,
            warm_up->task,
            warm_up->scene,
            TaskMode::practice,
            task ? task->guide : true,
            {},
            {"warm_up", fmt::format("Warm up before the first work of the day: {} of {} left", left, warm_up->times)},
            left};
  }
  return next;
}

}  // namespace insula
