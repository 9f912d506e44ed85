// SPDX-License-Identifier: GPL-3.0-or-later
// Book-keeping of an exercise.
#include "core/sim/exercise.h"

#include <algorithm>
#include <cmath>

#include "core/base/input_error.h"
#include "core/sim/motion.h"

namespace insula {

int ExerciseLog::add_goal(std::string id, std::string text, bool required) {
  goals_.push_back({std::move(id), std::move(text), false, -1, required});
  return int(goals_.size()) - 1;
}

int ExerciseLog::add_fault(std::string id, std::string text) {
  FaultState& fault = faults_.emplace_back();
  fault.id = std::move(id);
  fault.text = std::move(text);
  fault.times.reserve(FaultState::most_times);
  return int(faults_.size()) - 1;
}

void ExerciseLog::advise(std::size_t first, const std::string& advice) {
  for (std::size_t i = first; i < faults_.size(); ++i)
    if (faults_[i].advice.empty()) faults_[i].advice = advice;
}

int ExerciseLog::add_timer(std::string id, std::string text, double limit_s) {
  timers_.push_back({std::move(id), std::move(text), limit_s, 0, false, 0});
  return int(timers_.size()) - 1;
}

int ExerciseLog::add_measure(std::string id, std::string text, std::string unit, std::string limit) {
  measures_.push_back({std::move(id), std::move(text), std::move(unit), false, 0, 0, std::move(limit)});
  return int(measures_.size()) - 1;
}

void ExerciseLog::goal(int index, double time) {
  GoalState& g = goals_[std::size_t(index)];
  if (g.done || state_ != ExerciseState::running) return;
  g.done = true;
  g.time = time;
  events.emit({"goal", g.id, g.text, 0, time});
  for (const GoalState& other : goals_)
    if (other.required && !other.done) return;
  state_ = ExerciseState::done;
  end_time_ = time;
  events.emit({"end", "done", "Exercise complete", 0, time});
}

void ExerciseLog::goal_lost(int index, double time) {
  GoalState& g = goals_[std::size_t(index)];
  if (!g.done || state_ != ExerciseState::running) return;
  g.done = false;
  g.time = -1;
  events.emit({"goal_lost", g.id, g.text, 0, time});
}

void ExerciseLog::timer(int index, double elapsed_s, bool running) {
  TimerState& t = timers_[std::size_t(index)];
  t.elapsed = std::isfinite(elapsed_s) ? elapsed_s : 0;
  t.running = running;
  t.longest = std::max(t.longest, t.elapsed);
}

void ExerciseLog::measure(int index, double value, int good) {
  MeasureState& m = measures_[std::size_t(index)];
  m.known = std::isfinite(value);
  m.value = m.known ? value : 0;
  m.good = m.known ? good : 0;
}

void ExerciseLog::fault(int index, double time, double value) {
  if (state_ != ExerciseState::running) return;
  FaultState& f = faults_[std::size_t(index)];
  ++f.count;
  f.last_time = time;
  if (f.times.size() < FaultState::most_times) f.times.push_back(time);
  message_ = f.text;
  events.emit({"fault", f.id, f.text, value, time});
}

void ExerciseLog::message(std::string text, double time) {
  message_ = text;
  events.emit({"message", "", std::move(text), 0, time});
}

void ExerciseLog::fail(std::string why, double time) {
  if (state_ != ExerciseState::running) return;
  state_ = ExerciseState::failed;
  message_ = why;
  end_time_ = time;
  events.emit({"end", "failed", std::move(why), 0, time});
}

void ExerciseLog::reset() {
  for (GoalState& g : goals_) {
    g.done = false;
    g.time = -1;
  }
  for (FaultState& f : faults_) {
    f.count = 0;
    f.last_time = -1;
    f.times.clear();
  }
  for (TimerState& t : timers_) {
    t.elapsed = t.longest = 0;
    t.running = false;
  }
  for (MeasureState& m : measures_) {
    m.known = false;
    m.value = 0;
    m.good = 0;
  }
  state_ = ExerciseState::running;
  message_.clear();
  end_time_ = -1;
  events.clear();
}

void MotionEntry::prepare(PrepareContext& context) {
  try {
    load_motion(file());
  } catch (const InputError& e) {
    error(context, file, e.what());
  }
}

void Exercise::connect(PrepareContext& context, const Simulation& simulation) {
  rules_ = children_of<ExerciseRule>();
  for (ExerciseRule* r : rules_) {
    const std::size_t first = log_.faults().size();
    r->declare(context, simulation, log_);
    log_.advise(first, r->advice());
  }
}

void Exercise::observe(const StepReport& report) {
  for (ExerciseRule* r : rules_) r->observe(report, log_);
}

void Exercise::reset() {
  log_.reset();
  for (ExerciseRule* r : rules_) r->reset();
}

}  // namespace insula
