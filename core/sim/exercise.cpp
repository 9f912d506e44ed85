// SPDX-License-Identifier: GPL-3.0-or-later
// Book-keeping of an exercise.
#include "core/sim/exercise.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "core/base/input_error.h"
#include "core/base/spoken.h"
#include "core/sim/channel_table.h"
#include "core/sim/motion.h"
#include "core/sim/simulation.h"

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

namespace {

/// The good values of a measure as text: "at most 10 %".
std::string limit_text(const MeasureState& m) {
  const auto& [from, to] = m.band;
  const std::string unit = m.unit.empty() ? "" : " " + m.unit;
  if (from && to) return fmt::format("{:g} to {:g}{}", *from, *to, unit);
  if (from) return fmt::format("at least {:g}{}", *from, unit);
  if (to) return fmt::format("at most {:g}{}", *to, unit);
  return {};
}

}  // namespace

int ExerciseLog::add_measure(std::string id, std::string text, std::string unit,
                             const std::array<std::optional<double>, 2>& band) {
  measures_.push_back({std::move(id), std::move(text), std::move(unit), false, 0, 0, band, {}});
  measures_.back().limit = limit_text(measures_.back());
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

void ExerciseLog::reopen(double time) {
  if (state_ != ExerciseState::done) return;
  state_ = ExerciseState::running;
  end_time_ = -1;
  events.emit({"reopened", "", "The exercise goes on", 0, time});
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

std::string measure_id(const ChannelBase& channel, std::size_t item) {
  return channel.name(item) + (channel.display_unit() == "%" ? "_pct" : "");
}

void Exercise::connect(PrepareContext& context, const Simulation& simulation) {
  rules_ = children_of<ExerciseRule>();
  for (ExerciseRule* r : rules_) {
    const std::size_t first = log_.faults().size();
    r->declare(context, simulation, log_);
    log_.advise(first, r->advice());
  }
  metric_sets_ = children_of<MetricSet>();
  for (MetricSet* m : metric_sets_) m->declare(context, simulation);
  add_measures(simulation);
}

namespace {

/// Whether another component has a metric of that name.
bool has_namesake(const std::vector<MetricSet*>& sets, const MetricSet& own, const MetricBase& metric) {
  return std::any_of(sets.begin(), sets.end(), [&](const MetricSet* other) {
    return other != &own && std::any_of(other->metrics().begin(), other->metrics().end(),
                                        [&](const MetricBase* m) { return m->spec().name == metric.spec().name; });
  });
}

}  // namespace

std::vector<MetricValue> Exercise::metrics() const {
  std::vector<MetricValue> out;
  for (MetricSet* set : metric_sets_) {
    set->evaluate();
    for (const MetricBase* m : set->metrics()) {
      const bool each = m->spec().of == Of::each_hand;
      const std::string prefix = has_namesake(metric_sets_, *set, *m) ? set->id + "." : "";
      for (std::size_t item = 0; item < m->items().size(); ++item)
        for (int hand = each ? left_hand : both_hands; hand <= (each ? right_hand : both_hands); ++hand) {
          const double si = m->value(item, hand);
          MetricValue& v = out.emplace_back();
          v.id = prefix + m->id(item);
          v.text = m->single() ? m->spec().doc : m->spec().doc + ": " + spoken(m->items()[item]);
          v.source = m->spec().source;
          v.hand = hand;
          v.known = std::isfinite(si);
          v.value = v.known ? si * m->displayed().scale() : 0;
          v.unit = m->displayed().unit();
          v.digits = m->displayed().digits();
          v.better = m->spec().better;
        }
    }
  }
  return out;
}

void Exercise::add_measures(const Simulation& simulation) {
  const auto& entries = simulation.channels().entries();
  const auto is_measure = [](const ChannelEntry& e) { return e.channel->spec().measure && e.size() == 1; };
  for (const ChannelEntry& e : entries) {
    if (!is_measure(e)) continue;
    const ChannelBase& c = *e.channel;
    std::string name = measure_id(c, e.item), text(c.spec().doc);
    const auto same = std::count_if(entries.begin(), entries.end(), [&](const ChannelEntry& other) {
      return is_measure(other) && measure_id(*other.channel, other.item) == name;
    });
    if (same > 1) name = e.component->id + "." + name;
    if (!c.single()) text += ": " + spoken(e.group());
    ChannelBase::Bounds band = c.good();
    for (auto& bound : band)
      if (bound) *bound *= c.display_scale();
    measured_.push_back({&e, log_.add_measure(std::move(name), std::move(text), std::string(c.display_unit()), band)});
  }
}

void Exercise::observe(const StepReport& report) {
  ran_ = log_.state() == ExerciseState::running;
  for (ExerciseRule* r : rules_) r->observe(report, log_);
  // An exercise that an instructor reopens in this step is measured again at once.
  if (!ran_ && log_.state() != ExerciseState::running) return;
  for (const Measured& m : measured_) {
    const ChannelBase& c = *m.entry->channel;
    const double si = *c.values(m.entry->item);
    log_.measure(m.index, si * c.display_scale(), c.judged(si));
  }
}

void Exercise::observe_metrics(const StepReport& report) {
  if (!ran_) return;
  for (MetricSet* m : metric_sets_) m->observe(report);
}

void Exercise::reset() {
  log_.reset();
  for (ExerciseRule* r : rules_) r->reset();
  for (MetricSet* m : metric_sets_) m->reset();
}

}  // namespace insula
