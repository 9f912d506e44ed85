// SPDX-License-Identifier: GPL-3.0-or-later
#include "training/curriculum/course.h"

#include <algorithm>

#include "training/curriculum/days.h"

namespace insula {
namespace {

void lapse(TaskState& state, TaskState::Lapse why, std::int64_t ms) {
  state.held = false;
  state.lapse = why;
  state.lapsed_ms = ms;
  state.counted.clear();
  state.due_ms.reset();
  state.missed_ms.reset();
}

bool all_gates_met(const TaskState& state) {
  const auto met = [&](const Gate& gate) {
    return run_length(state.counted, gate, state.counted.back()->began_ms) >= gate.in_a_row;
  };
  return std::all_of(state.task->gates.begin(), state.task->gates.end(), met);
}

}  // namespace

int run_length(const std::vector<const Attempt*>& attempts, const Gate& gate, std::int64_t until_ms) {
  int run = 0;
  for (auto a = attempts.rbegin(); a != attempts.rend() && run < gate.in_a_row; ++a, ++run)
    if (!satisfies(**a, gate) || (gate.within_ms > 0 && until_ms - (*a)->began_ms > gate.within_ms)) break;
  return run;
}

Course::Course(const Curriculum& curriculum, std::int64_t offset_ms) : curriculum_(curriculum), offset_ms_(offset_ms) {
  for (const Module& module : curriculum.modules) {
    states_.emplace_back();
    for (const Task& task : module.tasks) states_.back().push_back({&task, {}});
  }
}

void Course::advance(std::int64_t ms) {
  for (auto& module : states_)
    for (TaskState& state : module)
      if (state.missed_ms && ms >= *state.missed_ms) lapse(state, TaskState::Lapse::missed, *state.missed_ms);
}

void Course::add(const Attempt& attempt) {
  advance(attempt.began_ms);
  // What the attempt passes opens other tasks for later attempts only.
  std::vector<TaskState*> taking;
  for (std::size_t m = 0; m < states_.size(); ++m)
    for (std::size_t t = 0; t < states_[m].size(); ++t)
      if (counts_for(attempt, *states_[m][t].task) && task_locks(m, t).empty()) taking.push_back(&states_[m][t]);
  for (TaskState* state : taking) take(*state, attempt);
}

void Course::take(TaskState& state, const Attempt& attempt) const {
  ++state.attempts;
  if (state.held) return take_repetition(state, attempt);
  state.counted.push_back(&attempt);
  if (!all_gates_met(state)) return;
  state.held = true;
  state.lapse = TaskState::Lapse::none;
  state.passed_ms = attempt.began_ms;
  state.repetitions = 0;
  if (!state.attempts_to_level) state.attempts_to_level = state.attempts;
  schedule(state, attempt.began_ms);
}

void Course::take_repetition(TaskState& state, const Attempt& attempt) const {
  if (!state.due_ms || attempt.began_ms < *state.due_ms) return;
  const auto& gates = state.task->gates;
  const bool good = std::all_of(gates.begin(), gates.end(), [&](const Gate& g) { return satisfies(attempt, g); });
  if (!good) return lapse(state, TaskState::Lapse::failed, attempt.began_ms);
  ++state.repetitions;
  schedule(state, attempt.began_ms);
}

void Course::schedule(TaskState& state, std::int64_t from_ms) const {
  state.due_ms.reset();
  state.missed_ms.reset();
  const auto& repetition = state.task->repetition;
  if (!repetition || repetition->after_ms.empty()) return;
  const auto& after = repetition->after_ms;
  if (std::size_t(state.repetitions) >= after.size() && !repetition->keep_on) return;
  const std::int64_t wanted = after[std::min(std::size_t(state.repetitions), after.size() - 1)];
  const std::int64_t interval = std::clamp<std::int64_t>(wanted, 0, most_ms);
  const std::int64_t due = from_ms + interval;
  state.due_ms = interval % day_ms == 0 ? start_of_day(due, offset_ms_) : due;
  state.missed_ms = *state.due_ms + std::clamp<std::int64_t>(repetition->grace_ms, 0, most_ms);
}

const TaskState* Course::find(const std::string& task) const {
  for (const auto& module : states_)
    for (const TaskState& state : module)
      if (state.task->id == task) return &state;
  return nullptr;
}

bool Course::module_ever_passed(const std::string& id) const {
  for (std::size_t m = 0; m < states_.size(); ++m)
    if (curriculum_.modules[m].id == id)
      return std::all_of(states_[m].begin(), states_[m].end(), [](const TaskState& s) { return s.ever_passed(); });
  return false;
}

std::vector<std::string> Course::module_locks(std::size_t module) const {
  std::vector<std::string> locks;
  for (const std::string& id : curriculum_.modules[module].needs)
    if (!module_ever_passed(id)) locks.push_back(id);
  return locks;
}

std::vector<std::string> Course::task_locks(std::size_t module, std::size_t task) const {
  const auto& states = states_[module];
  if (states[task].ever_passed()) return {};
  std::vector<std::string> locks = module_locks(module);
  if (!curriculum_.modules[module].in_order) return locks;
  for (std::size_t t = 0; t < task; ++t)
    if (!states[t].ever_passed()) locks.push_back(states[t].task->id);
  return locks;
}

}  // namespace insula
