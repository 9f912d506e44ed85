// SPDX-License-Identifier: GPL-3.0-or-later
// A target in space that the tip of one hand's tool must touch.
#pragma once
#include "plugins/skill_rules/skill_goal.h"

namespace insula {

class GoalTouch final : public SkillGoal {
 public:
  RefList<Body> while_held{
      this,
      {.name = "while_held",
       .fallback = "",
       .doc = "bodies of which the other hand must hold or press one meanwhile; none: it is free"}};
  Param<Force> held_force{this,
                          {.name = "held_force",
                           .fallback = "2 mN",
                           .min = "0.01 mN",
                           .max = "20 N",
                           .doc = "least force of the other hand on one of them"}};

  Channel<Length> off{this,
                      {.name = "off",
                       .doc = "distance of the tip from the middle of the target, in its turn",
                       .min = "0 mm",
                       .shown = Shown::none,
                       .display = "mm",
                       .digits = 1}};

  Channel<Scalar> unheld{this,
                         {.name = "unheld",
                          .doc = "1: the tip is at the target in its turn, but the other hand does not hold what it "
                                 "should",
                          .min = "0",
                          .max = "1",
                          .shown = Shown::none,
                          .digits = 0}};

  Marks<Points> ball{this, "1 mm"};

  void declare(PrepareContext& context, const Simulation& simulation, ExerciseLog& log) override {
    SkillGoal::declare(context, simulation, log);
    structure_.clear();
    for (const Body* body : while_held())
      structure_.push_back(std::size_t(std::max(0, structure_of(context, simulation, while_held, *body))));
  }
  void publish() override {
    SkillGoal::publish();
    off.set(turn() ? now_ : std::nan(""));
    unheld.set(turn() && now_ <= radius() && !held_ ? 1 : 0);
  }
  void reset() override {
    SkillGoal::reset();
    now_ = std::nan("");
    held_ = true;
  }

 protected:
  void mark(Look look, double share) override {
    Points& shown = ball.only(look);
    shown.resize(1);
    shown.set(0, at(), share);
  }
  bool good(const StepReport& report) override {
    now_ = distance(report);
    held_ = other_hand_holds(report);
    return now_ <= radius() && held_;
  }
  double deviation(const StepReport& report) const override { return distance(report); }

 private:
  bool other_hand_holds(const StepReport& report) const {
    if (structure_.empty()) return true;
    const std::size_t other = std::size_t(1 - hand_index());
    return std::any_of(structure_.begin(), structure_.end(),
                       [&](std::size_t i) { return report.structures[i].of_hand[other].norm() >= held_force(); });
  }

  std::vector<std::size_t> structure_;  ///< among those of the report
  double now_ = std::nan("");           ///< m
  bool held_ = true;                    ///< by the other hand
};

}  // namespace insula
