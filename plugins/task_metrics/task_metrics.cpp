// SPDX-License-Identifier: GPL-3.0-or-later
/*
# task_metrics

Metrics of a task, that its author declares in the scene. `exercise_metrics` gives the time of each phase, the number of
each fault and the longest time of each clock. `event_metric` counts events, such as torn strands. `channel_metric`
takes a statistic of a channel, such as the blood lost at the end, or the time in which the lips were held apart.
`region_touch_metric` tells how long tools, and clips in an applier, touched a region of a vessel, such as the dome.

A phase is the time from the goal before, or from the start, until a goal is reached. All metrics count while the
exercise runs. The id of an `event_metric` or a `channel_metric` is the name of its metric.
*/
#include <algorithm>
#include <cmath>
#include <memory>

#include "core/registry/registry.h"
#include "core/sim/metric.h"
#include "core/sim/simulation.h"
#include "plugins/exercise_rules/channel_rules.h"
#include "plugins/task_metrics/register.h"

namespace insula {
namespace {

Better better_of(const Param<Choice>& choice) {
  return choice.is("low") ? Better::low : choice.is("high") ? Better::high : Better::none;
}

class ExerciseMetrics final : public MetricSet {
 public:
  Metric<Duration> time{this,
                        {.name = "time",
                         .doc = "Time of the exercise",
                         .source = "Cotin et al., MICCAI 2002",
                         .better = Better::low,
                         .of = Of::both_hands,
                         .display = "s",
                         .digits = 1}};
  Metric<Scalar> all_faults{this,
                            {.name = "fault_count",
                             .doc = "Number of all faults",
                             .source = "Insula",
                             .better = Better::low,
                             .of = Of::both_hands,
                             .digits = 0}};
  MetricGroup<Duration> phase{this,
                              {.name = "phase_time",
                               .doc = "Time for the goal",
                               .source = "Insula",
                               .better = Better::low,
                               .of = Of::both_hands,
                               .display = "s",
                               .digits = 1}};
  MetricGroup<Scalar> faults{this,
                             {.name = "faults",
                              .doc = "Number of faults",
                              .source = "Insula",
                              .better = Better::low,
                              .of = Of::both_hands,
                              .digits = 0}};
  MetricGroup<Duration> clock{this,
                              {.name = "clock_longest",
                               .doc = "Longest time of the clock",
                               .source = "Insula",
                               .better = Better::low,
                               .of = Of::both_hands,
                               .display = "s",
                               .digits = 1}};

  void declare(PrepareContext&, const Simulation& simulation) override {
    log_ = &simulation.exercise()->log();
    const auto ids = [](const auto& list) {
      std::vector<std::string> out;
      for (const auto& item : list) out.push_back(item.id);
      return out;
    };
    phase.declare_items(ids(log_->goals()));
    faults.declare_items(ids(log_->faults()));
    clock.declare_items(ids(log_->timers()));
  }
  void observe(const StepReport& r) override { time_s_ += r.h; }
  void reset() override { time_s_ = 0; }

  void evaluate() override {
    for (MetricBase* m : metrics()) m->reset();
    time.set(time_s_);
    int sum = 0;
    for (std::size_t i = 0; i < log_->faults().size(); ++i) {
      faults.set(i, both_hands, log_->faults()[i].count);
      sum += log_->faults()[i].count;
    }
    all_faults.set(sum);
    for (std::size_t i = 0; i < log_->timers().size(); ++i) clock.set(i, both_hands, log_->timers()[i].longest);
    const auto& goals = log_->goals();
    for (std::size_t i = 0; i < goals.size(); ++i) {
      if (!goals[i].done) continue;
      double before = 0;
      for (const GoalState& other : goals)
        if (other.done && other.time < goals[i].time) before = std::max(before, other.time);
      phase.set(i, both_hands, goals[i].time - before);
    }
  }

 private:
  const ExerciseLog* log_ = nullptr;
  double time_s_ = 0;
};

/// A metric whose name and unit the scene states.
class AuthoredMetric : public MetricSet {
 public:
  Param<std::string> text{this, {.name = "text", .doc = "what it is, for the trainee"}};
  Param<Choice> better{this,
                       {.name = "better",
                        .fallback = "none",
                        .choices = {"none", "low", "high"},
                        .doc = "which direction shows more skill"}};
  Param<std::string> source{
      this, {.name = "source", .fallback = "the scene's author", .doc = "who defines it: a publication"}};

 protected:
  void make(DisplayedQuantity::Quantity quantity, Of of, std::string_view display, int digits) {
    metric_ = std::make_unique<MetricBase>(
        this, MetricSpec{id, text(), source(), better_of(better), of, display, digits}, quantity, true);
  }
  MetricBase* metric() { return metric_.get(); }

 private:
  std::unique_ptr<MetricBase> metric_;
};

class EventMetric final : public AuthoredMetric {
 public:
  Param<std::string> event{this, {.name = "event", .doc = "event that is counted: \"strand_torn\""}};
  Param<bool> each_hand{
      this, {.name = "each_hand", .fallback = "false", .doc = "whether the events of each hand are counted for it"}};

  void declare(PrepareContext& context, const Simulation& simulation) override {
    check_event(context, simulation, *this, event);
    make(DisplayedQuantity::quantity_of<Scalar>(), each_hand() ? Of::each_hand : Of::both_hands, "", 0);
  }
  void observe(const StepReport& r) override {
    for (const Event& e : r.events) {
      if (e.kind != event()) continue;
      ++count_[both_hands];
      if (e.hand == left_hand || e.hand == right_hand) ++count_[std::size_t(e.hand)];
    }
  }
  void reset() override { count_ = {}; }
  void evaluate() override {
    for (std::size_t i = 0; i < count_.size(); ++i) metric()->set_value(0, int(i), count_[i]);
  }

 private:
  std::array<int, 3> count_{};  ///< left, right, all
};

class ChannelMetric final : public AuthoredMetric {
 public:
  Param<std::string> channel{this, {.name = "channel", .doc = "component and channel: \"bleeding.lost\""}};
  Param<Choice> statistic{this,
                          {.name = "statistic",
                           .fallback = "last",
                           .choices = {"last", "mean", "largest", "smallest", "time_above", "time_below"},
                           .doc = "what is taken of it; the times need a limit"}};
  Param<std::string> limit{this,
                           {.name = "limit", .fallback = "", .doc = "limit with a unit of the channel: \"5 mm\""}};

  void declare(PrepareContext& context, const Simulation& simulation) override {
    timed_ = statistic.is("time_above") || statistic.is("time_below");
    if (timed_ && limit().empty()) error(context, limit, "must be stated for a time");
    if (!timed_ && !limit().empty()) error(context, limit, "is only for times");
    const bool found = timed_ && !limit().empty() ? watch_.connect(context, simulation, *this, channel, limit)
                                                  : watch_.find(context, simulation, *this, channel);
    if (!found) return;
    const ChannelBase& c = *watch_.entry()->channel;
    if (timed_) make(DisplayedQuantity::quantity_of<Duration>(), Of::both_hands, "s", 1);
    else make(c.quantity(), Of::both_hands, c.spec().display, c.spec().digits);
  }
  void observe(const StepReport& r) override {
    const double v = watch_.value(r);
    if (!std::isfinite(v)) return;
    last_ = v;
    sum_ += r.h * v;
    time_s_ += r.h;
    largest_ = std::max(largest_, v);
    smallest_ = std::min(smallest_, v);
    using Comparison = ChannelWatch::Comparison;
    if (watch_.beyond(v, statistic.is("time_above") ? Comparison::above : Comparison::below)) beyond_s_ += r.h;
  }
  void reset() override {
    last_ = NAN;
    sum_ = time_s_ = beyond_s_ = 0;
    largest_ = -INFINITY;
    smallest_ = INFINITY;
  }
  void evaluate() override {
    metric()->reset();
    if (!(time_s_ > 0)) return;
    metric()->set_value(0, both_hands,
                        timed_                     ? beyond_s_
                        : statistic.is("mean")     ? sum_ / time_s_
                        : statistic.is("largest")  ? largest_
                        : statistic.is("smallest") ? smallest_
                                                   : last_);
  }

 private:
  ChannelWatch watch_;
  bool timed_ = false;
  double last_ = NAN, sum_ = 0, time_s_ = 0, beyond_s_ = 0, largest_ = -INFINITY, smallest_ = INFINITY;
};

}  // namespace
}  // namespace insula

INSULA_PLUGIN(task_metrics) {
  using namespace insula;
  registry.add<ExerciseMetrics>("exercise_metrics", Kind::metric, "time of each phase, faults and clocks");
  registry.add<EventMetric>("event_metric", Kind::metric, "how often an event happened");
  registry.add<ChannelMetric>("channel_metric", Kind::metric, "a statistic of a channel");
  register_region_touch_metric(registry);
}
