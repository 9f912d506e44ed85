// SPDX-License-Identifier: GPL-3.0-or-later
// The attempts in order, and what the progress says of the end of a person's way.
#include "training/curriculum/evaluate.h"

#include <fmt/format.h>

#include <algorithm>
#include <compare>
#include <tuple>

#include "core/base/text.h"
#include "training/curriculum/course.h"
#include "training/curriculum/days.h"

namespace insula {
namespace {

std::strong_ordering order_of(const std::map<std::pair<std::string, std::string>, double>& a,
                              const std::map<std::pair<std::string, std::string>, double>& b) {
  return std::lexicographical_compare_three_way(a.begin(), a.end(), b.begin(), b.end(),
                                                [](const auto& x, const auto& y) {
                                                  const std::strong_ordering key = x.first <=> y.first;
                                                  return key != 0 ? key : std::strong_order(x.second, y.second);
                                                });
}

/// By time. Attempts of one moment have an order that does not depend on how they were given.
bool earlier(const Attempt* a, const Attempt* b) {
  const auto rest = [](const Attempt& x) {
    return std::tie(x.began_ms, x.scene, x.mode, x.done, x.seed, x.guided, x.run);
  };
  if (rest(*a) != rest(*b)) return rest(*a) < rest(*b);
  if (a->faults != b->faults) return a->faults < b->faults;
  return order_of(a->metrics, b->metrics) < 0;
}

std::vector<const Attempt*> in_order(std::span<const Attempt> attempts, std::int64_t now_ms) {
  std::vector<const Attempt*> out;
  for (const Attempt& a : attempts)
    if (a.began_ms >= -most_ms && a.began_ms <= now_ms && (a.mode == "practice" || a.mode == "test")) out.push_back(&a);
  std::stable_sort(out.begin(), out.end(), earlier);
  return out;
}

Standing standing_of(const TaskState& state, bool locked, std::int64_t now_ms) {
  if (locked) return Standing::locked;
  if (state.lapse != TaskState::Lapse::none) return Standing::lapsed;
  if (!state.held) return Standing::open;
  return state.due_ms && now_ms >= *state.due_ms ? Standing::due : Standing::passed;
}

/// "goals reached (1 of 3 in a row); no faults", the gates that are not met.
std::string missing_text(const std::vector<GateProgress>& gates) {
  std::vector<std::string> parts;
  for (const GateProgress& g : gates)
    if (!g.met)
      parts.push_back(g.needed > 1 ? fmt::format("{} ({} of {} in a row)", g.text, g.in_a_row, g.needed) : g.text);
  return joined(parts, "; ");
}

Reason reason_of(const TaskProgress& task, const TaskState& state, std::int64_t offset_ms) {
  const auto date = [&](std::int64_t ms) { return date_text(ms, offset_ms); };
  switch (task.standing) {
    case Standing::locked: return {"locked", "Opens when these have been passed: " + joined(task.locked_by)};
    case Standing::open: return {"open", "Still needed: " + missing_text(task.gates)};
    case Standing::passed:
      return {"passed", "Passed on " + date(*task.passed_ms) +
                            (task.due_ms ? "; the next repetition is due on " + date(*task.due_ms) : "")};
    case Standing::due:
      return {"repetition_due", fmt::format("A repetition is due since {}; it is missed on {}", date(*task.due_ms),
                                            date(*task.missed_ms))};
    case Standing::lapsed: break;
  }
  const bool failed = state.lapse == TaskState::Lapse::failed;
  return {failed ? "repetition_failed" : "repetition_missed",
          fmt::format("A repetition was {} on {}. Still needed: {}", failed ? "not passed" : "missed",
                      date(state.lapsed_ms), missing_text(task.gates))};
}

std::vector<GateProgress> gates_of(const TaskState& state, std::int64_t now_ms) {
  std::vector<GateProgress> out;
  for (const Gate& gate : state.task->gates) {
    const int run = state.held ? gate.in_a_row : run_length(state.counted, gate, now_ms);
    out.push_back({gate.text, run, gate.in_a_row, run >= gate.in_a_row});
  }
  return out;
}

TaskProgress task_progress(const TaskState& state, std::vector<std::string> locks, std::int64_t now_ms,
                           std::int64_t offset_ms) {
  TaskProgress out;
  out.id = state.task->id;
  out.standing = standing_of(state, !locks.empty(), now_ms);
  out.locked_by = std::move(locks);
  out.gates = gates_of(state, now_ms);
  out.attempts = state.attempts;
  for (const Attempt* a : state.counted) out.runs.push_back(a->run);
  out.attempts_to_level = state.attempts_to_level;
  out.passed_ms = state.passed_ms;
  out.repetitions = state.repetitions;
  out.due_ms = state.due_ms;
  out.missed_ms = state.missed_ms;
  const auto& seeds = state.task->seeds;
  if (!seeds.empty()) out.next_seed = seeds[std::size_t(state.attempts) % seeds.size()];
  out.why = reason_of(out, state, offset_ms);
  return out;
}

Standing module_standing(const ModuleProgress& module) {
  const auto any = [&](Standing wanted) {
    return std::any_of(module.tasks.begin(), module.tasks.end(), [&](const auto& t) { return t.standing == wanted; });
  };
  if (any(Standing::lapsed)) return Standing::lapsed;
  if (any(Standing::due)) return Standing::due;
  if (!module.locked_by.empty()) return Standing::locked;
  return any(Standing::open) || any(Standing::locked) ? Standing::open : Standing::passed;
}

}  // namespace

std::string_view standing_name(Standing standing) {
  switch (standing) {
    case Standing::locked: return "locked";
    case Standing::open: return "open";
    case Standing::passed: return "passed";
    case Standing::due: return "due";
    case Standing::lapsed: return "lapsed";
  }
  return "open";
}

Progress evaluate(const Curriculum& curriculum, std::span<const Attempt> attempts, std::int64_t now_ms,
                  std::chrono::minutes utc_offset) {
  now_ms = std::clamp(now_ms, -most_ms, most_ms);
  const std::int64_t offset_ms = 60'000 * std::clamp<std::int64_t>(utc_offset.count(), -24 * 60, 24 * 60);
  const std::vector<const Attempt*> ordered = in_order(attempts, now_ms);
  Course course(curriculum, offset_ms);
  for (const Attempt* a : ordered) course.add(*a);
  course.advance(now_ms);
  Progress out;
  for (std::size_t m = 0; m < curriculum.modules.size(); ++m) {
    ModuleProgress module{curriculum.modules[m].id, Standing::open, course.module_locks(m), {}};
    for (std::size_t t = 0; t < course.tasks(m).size(); ++t)
      module.tasks.push_back(task_progress(course.tasks(m)[t], course.task_locks(m, t), now_ms, offset_ms));
    module.standing = module_standing(module);
    out.modules.push_back(std::move(module));
  }
  out.passed = std::all_of(out.modules.begin(), out.modules.end(), [](const ModuleProgress& m) {
    return m.standing == Standing::passed || m.standing == Standing::due;
  });
  out.next = recommend(curriculum, course, out, ordered, now_ms, offset_ms);
  return out;
}

}  // namespace insula
