// SPDX-License-Identifier: GPL-3.0-or-later
// A goal and a fault on an event of a component.
#include "core/registry/registry.h"
#include "plugins/exercise_rules/channel_rules.h"
#include "plugins/exercise_rules/register.h"

namespace insula {
namespace {

class GoalEvent final : public ExerciseRule {
 public:
  Param<std::string> text{this, {.name = "text", .doc = "what the trainee is to do"}};
  Param<std::string> event{this, {.name = "event", .doc = "event that is to be caused: \"clip_shut\""}};
  Param<int> count{this, {.name = "count", .fallback = "1", .min = "1", .max = "100000", .doc = "how often"}};
  Param<std::string> channel{
      this,
      {.name = "channel", .fallback = "", .doc = "channel that decides whether an event counts; none: each counts"}};
  Param<Choice> comparison{this,
                           {.name = "comparison",
                            .fallback = "above",
                            .choices = {"above", "below"},
                            .doc = "on which side of the limit of the channel an event counts"}};
  Param<std::string> limit{this,
                           {.name = "limit", .fallback = "", .doc = "limit with a unit of the channel: \"0.2 N\""}};

  void declare(PrepareContext& context, const Simulation& simulation, ExerciseLog& log) override {
    goal_ = log.add_goal(id, text());
    if (!channel().empty()) watch_.connect(context, simulation, *this, channel, limit);
    else if (limit.given()) error(context, limit, "is a limit of no channel");
    check_event(context, simulation, *this, event);
    reset();
  }
  void observe(const StepReport& r, ExerciseLog& log) override {
    if (!channel().empty() && !watch_.beyond(watch_.value(r), comparison_of(comparison))) return;
    for (const Event& e : r.events) counted_ += e.kind == event();
    if (counted_ >= count()) log.goal(goal_, r.time);
  }
  void reset() override { counted_ = 0; }

 private:
  ChannelWatch watch_;
  int goal_ = 0, counted_ = 0;
};

class FaultEvent final : public ExerciseRule {
 public:
  Param<std::string> text{this, {.name = "text", .doc = "what the trainee is told"}};
  Param<std::string> event{this, {.name = "event", .doc = "event that is a fault each time: \"vein_parted\""}};

  void declare(PrepareContext& context, const Simulation& simulation, ExerciseLog& log) override {
    fault_ = log.add_fault(id, text());
    check_event(context, simulation, *this, event);
  }
  void observe(const StepReport& r, ExerciseLog& log) override {
    for (const Event& e : r.events)
      if (e.kind == event()) log.fault(fault_, r.time, e.value);
  }

 private:
  int fault_ = 0;
};

}  // namespace

void register_event_rules(Registry& registry) {
  registry.add<GoalEvent>("goal_event", Kind::exercise_rule,
                          "reached when an event has happened often enough, or often enough while a channel allows it");
  registry.add<FaultEvent>("fault_event", Kind::exercise_rule, "counts each event of a kind");
}

}  // namespace insula
