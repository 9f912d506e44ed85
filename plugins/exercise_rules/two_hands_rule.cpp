// SPDX-License-Identifier: GPL-3.0-or-later
// A goal for two hands that work at the same time. It counts the events that one hand causes while the other hand holds
// or presses tissue, or while a channel shows its work. One hand alone can never reach it. If too few of what the event
// needs are left, the exercise fails, so that nobody goes on in vain.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "core/registry/registry.h"
#include "plugins/exercise_rules/channel_rules.h"
#include "plugins/exercise_rules/register.h"

namespace insula {
namespace {

class GoalTwoHands final : public ExerciseRule {
 public:
  Param<std::string> text{this,
                          {.name = "text", .fallback = "Use both hands together", .doc = "what the trainee is to do"}};
  Param<std::string> event{this, {.name = "event", .doc = "event that one hand causes: \"strand_cut\""}};
  Param<int> count{
      this,
      {.name = "count", .fallback = "1", .min = "1", .max = "100000", .doc = "events that must be caused together"}};
  RefList<Body> on{
      this,
      {.name = "on", .fallback = "", .doc = "tissue that the other hand holds or presses; none: any work counts"}};
  Param<Force> force{this,
                     {.name = "force",
                      .fallback = "0.02 N",
                      .min = "0.0001 N",
                      .max = "20 N",
                      .doc = "least force of the other hand on one of these bodies"}};
  Param<std::string> channel{
      this,
      {.name = "channel", .fallback = "", .doc = "channel that shows the other hand's work: \"bleeding.sucked\""}};
  Param<std::string> limit{
      this, {.name = "limit", .fallback = "", .doc = "value above which it works, with a unit of the channel"}};
  Param<std::string> remaining{
      this,
      {.name = "remaining",
       .fallback = "",
       .doc = "channel that counts how often the event can still happen: \"arachnoid.standing\"; if too few are left, "
              "the exercise has failed"}};
  Param<Duration> within{this,
                         {.name = "within",
                          .fallback = "0.5 s",
                          .min = "0 s",
                          .max = "10 s",
                          .doc = "a pause of the other hand that is forgiven"}};

  Channel<Scalar> together{this,
                           {.name = "together",
                            .doc = "Times that both hands worked together",
                            .min = "0",
                            .shown = Shown::none,
                            .digits = 0,
                            .measure = true}};

  void prepare(PrepareContext&) override { together.set_bands({double(count()), std::nullopt}, {0.0, std::nullopt}); }
  void declare(PrepareContext& context, const Simulation& simulation, ExerciseLog& log) override {
    goal_ = log.add_goal(id, text());
    structure_.clear();
    const auto& structures = simulation.report().structures;
    for (std::size_t i = 0; i < structures.size(); ++i)
      for (const Body* body : on())
        if (structures[i].body == body) structure_.push_back(i);
    if (structure_.size() != on().size()) error(context, on, "names a tool or an implant, not tissue");
    if (on().empty() == channel().empty())
      return error(context, "needs either \"on\" or \"channel\" to see the other hand's work");
    if (!channel().empty()) watch_.connect(context, simulation, *this, channel, limit);
    if (!remaining().empty()) remaining_.find(context, simulation, *this, remaining);
    check_event(context, simulation, *this, event);
    reset();
  }

  void observe(const StepReport& r, ExerciseLog& log) override {
    for (std::size_t hand = 0; hand < 2; ++hand) idle_[hand] = works(r, hand) ? 0 : idle_[hand] + r.h;
    for (const Event& e : r.events) {
      if (e.kind != event() || e.hand < 0 || e.hand > 1) continue;
      if (idle_[std::size_t(1 - e.hand)] <= within() + 1e-9) ++together_;
    }
    together.set(together_);
    if (together_ >= count()) return log.goal(goal_, r.time);
    const double left = remaining_.value(r);
    if (together_ + left < count())
      log.fail(fmt::format("Out of reach: {} of {} were done, and {:.0f} are left. Begin again: {}", together_, count(),
                           left, text()),
               r.time);
  }

  void reset() override {
    idle_ = {infinite, infinite};
    together_ = 0;
  }

 private:
  /// Whether this hand holds or presses one of the bodies, or the channel is above its limit.
  bool works(const StepReport& r, std::size_t hand) const {
    if (!channel().empty()) return watch_.beyond(watch_.value(r), ChannelWatch::Comparison::above);
    return std::any_of(structure_.begin(), structure_.end(),
                       [&](std::size_t i) { return r.structures[i].of_hand[hand].norm() >= force(); });
  }

  ChannelWatch watch_, remaining_;
  int goal_ = 0, together_ = 0;
  std::vector<std::size_t> structure_;              ///< among those of the report
  std::array<double, 2> idle_{infinite, infinite};  ///< time since each hand worked, s
};

}  // namespace

void register_two_hands_rule(Registry& registry) {
  registry.add<GoalTwoHands>("goal_two_hands", Kind::exercise_rule,
                             "reached when one hand has acted often enough while the other one worked");
}

}  // namespace insula
