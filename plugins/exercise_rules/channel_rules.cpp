// SPDX-License-Identifier: GPL-3.0-or-later
// A goal and a fault on any channel of the scene, and a fault for each event of a kind. The comparison is with the
// value at the end of each step. A goal is reached when the channel has been beyond the limit for `hold`. A fault
// counts when it has been so for longer than `grace`, and counts again once the channel has come back by a tenth of the
// limit.
#include "plugins/exercise_rules/channel_rules.h"

#include <algorithm>
#include <cmath>

#include "core/base/text.h"
#include "core/params/number.h"
#include "core/registry/registry.h"
#include "core/sim/watched_limit.h"
#include "plugins/exercise_rules/register.h"

namespace insula {

void check_event(PrepareContext& context, const Simulation& simulation, const Component& owner,
                 const Param<std::string>& event) {
  std::vector<std::string> known;
  for (const Component* c : simulation.scene().components())
    for (const EventKind* e : c->event_kinds()) known.push_back(e->name());
  if (std::find(known.begin(), known.end(), event()) != known.end()) return;
  const std::string near = nearest_name(event(), known);
  owner.error(context, event, "no component of the scene has the event " + in_quotes(event()) + did_you_mean(near));
}

bool ChannelWatch::find(PrepareContext& context, const Simulation& simulation, const Component& rule,
                        const Param<std::string>& channel) {
  entry_ = simulation.channels().find(channel());
  if (entry_) return true;
  const std::string near = nearest_name(channel(), simulation.channels().ids());
  rule.error(context, channel,
             "no component publishes the channel " + in_quotes(channel()) +
                 (near.empty() ? "; `insula describe NAME` lists those of an element" : did_you_mean(near)));
  return false;
}

bool ChannelWatch::connect(PrepareContext& context, const Simulation& simulation, const Component& rule,
                           const Param<std::string>& channel, const Param<std::string>& limit) {
  if (!find(context, simulation, rule, channel)) return false;
  std::string error;
  const auto& quantity = entry_->channel->quantity();
  const auto value = parse_quantity(limit(), quantity.units, quantity.name, error);
  if (!value) {
    rule.error(context, limit,
               error + "; " + in_quotes(channel()) + " is a " + std::string(quantity.name) +
                   (quantity.units.empty() ? "" : " in " + unit_list(quantity.units)));
    return false;
  }
  limit_ = *value;
  return true;
}

double ChannelWatch::value(const StepReport& report) const {
  if (!entry_ || report.channels.size() < entry_->offset + std::size_t(entry_->size())) return std::nan("");
  const double* v = report.channels.data() + entry_->offset;
  return entry_->size() == 3 ? std::sqrt(v[0] * v[0] + v[1] * v[1] + v[2] * v[2]) : v[0];
}

bool ChannelWatch::back(double value, Comparison comparison) const {
  const double margin = 0.1 * std::abs(limit_);
  return comparison == Comparison::above ? value <= limit_ - margin : value >= limit_ + margin;
}

ChannelWatch::Comparison comparison_of(const Param<Choice>& side) {
  return side.is("above") ? ChannelWatch::Comparison::above : ChannelWatch::Comparison::below;
}

namespace {

class GoalChannel final : public ExerciseRule {
 public:
  Param<std::string> text{this, {.name = "text", .doc = "what the trainee is to do"}};
  Param<std::string> channel{this, {.name = "channel", .doc = "component and channel: \"arachnoid.standing\""}};
  Param<Choice> comparison{this,
                           {.name = "comparison",
                            .fallback = "above",
                            .choices = {"above", "below"},
                            .doc = "on which side of the limit it is good"}};
  Param<std::string> limit{this, {.name = "limit", .doc = "limit with a unit of the channel: \"0.2 N\""}};
  Param<Duration> hold{
      this, {.name = "hold", .fallback = "0 s", .min = "0 s", .max = "600 s", .doc = "how long it must stay so"}};
  Param<Vec<Length>> at{this,
                        {.name = "at",
                         .fallback = "0 0 0 mm",
                         .doc = "where it is done: the guide of a trainee who practises stays at its target there "
                                "until the goal is reached; without it the guide goes on"}};

  Points place{this,
               {.name = "place",
                .doc = "where it is to be done, until it is reached",
                .material = "goal_place",
                .value = "0",
                .radius = "0.4 mm"}};

  void declare(PrepareContext& context, const Simulation& simulation, ExerciseLog& log) override {
    goal_ = log.add_goal(id, text());
    watch_.connect(context, simulation, *this, channel, limit);
  }
  void observe(const StepReport& r, ExerciseLog& log) override {
    const bool good = watch_.beyond(watch_.value(r), comparison_of(comparison));
    held_ = good ? held_ + r.h : 0;
    if (!good || held_ < hold() - 1e-9) return;
    reached_ = true;
    log.goal(goal_, r.time);
  }
  void publish() override {
    place.resize(at.given() && !reached_ ? 1 : 0);
    if (place.count() > 0) place.set(0, at(), 0);
  }
  void reset() override {
    held_ = 0;
    reached_ = false;
  }

 private:
  ChannelWatch watch_;
  int goal_ = 0;
  double held_ = 0;
  bool reached_ = false;
};

class FaultChannel final : public ExerciseRule, public WatchesLimits {
 public:
  Param<std::string> text{this, {.name = "text", .doc = "what the trainee is told"}};
  Param<std::string> channel{this, {.name = "channel", .doc = "component and channel: \"suture.tension\""}};
  Param<Choice> comparison{this,
                           {.name = "comparison",
                            .fallback = "above",
                            .choices = {"above", "below"},
                            .doc = "on which side of the limit it is bad"}};
  Param<std::string> limit{this, {.name = "limit", .doc = "limit with a unit of the channel: \"0.2 N\""}};
  Param<Duration> grace{
      this, {.name = "grace", .fallback = "0 s", .min = "0 s", .max = "600 s", .doc = "shorter times are forgiven"}};

  void declare(PrepareContext& context, const Simulation& simulation, ExerciseLog& log) override {
    fault_ = log.add_fault(id, text());
    watch_.connect(context, simulation, *this, channel, limit);
  }
  void observe(const StepReport& r, ExerciseLog& log) override {
    const double value = watch_.value(r);
    const bool bad = watch_.beyond(value, comparison_of(comparison));
    lasted_ = bad ? lasted_ + r.h : 0;
    if (bad && armed_ && lasted_ > grace() + 1e-9) {
      armed_ = false;
      log.fault(fault_, r.time, value);
    }
    if (watch_.back(value, comparison_of(comparison))) armed_ = true;
  }
  std::vector<WatchedLimit> watched_limits() const override {
    const ChannelEntry* e = watch_.entry();
    if (!e || e->size() != 1 || watch_.limit() == 0) return {};
    return {{e->channel, e->item, e->component, watch_.limit(), comparison.is("above"), -1}};
  }
  void reset() override {
    lasted_ = 0;
    armed_ = true;
  }

 private:
  ChannelWatch watch_;
  int fault_ = 0;
  double lasted_ = 0;
  bool armed_ = true;
};

}  // namespace

void register_channel_rules(Registry& registry) {
  registry.add<GoalChannel>("goal_channel", Kind::exercise_rule,
                            "reached when a channel has stayed on one side of a limit");
  registry.add<FaultChannel>("fault_channel", Kind::exercise_rule, "counts how often a channel goes beyond a limit");
}

}  // namespace insula
