// SPDX-License-Identifier: GPL-3.0-or-later
/*
# skill_rules

Goals of abstract skill tasks, and how exactly they were reached. Each goal has a marked place and a hand. `after` names
the goal that comes first. The goal whose turn is on is drawn in the colour of its hand, the later ones are pale.

`goal_touch` is reached when the tip of the hand's tool has been within `radius` of the target for `hold`. It may demand
that the other hand holds something meanwhile. `goal_hold_force` is reached when the hand's force on a body has been
within its band for `hold` at the marked place. `goal_clip_placed` is reached when a clip that was let go has lain with
its blades within `radius` of the mark, square to the tube, for `hold`. A clip that is let go elsewhere is a fault. A
force outside of the band, or a tip that leaves, begins the time afresh.

With d the distance of the tip from the middle of the target, or of the force from the middle of its band,

    error of a goal = integral of d dt / hold,   over the time that counted
*/
#include "core/registry/registry.h"
#include "plugins/skill_rules/goal_clip_placed.h"
#include "plugins/skill_rules/goal_hold_force.h"
#include "plugins/skill_rules/goal_touch.h"

namespace insula {
namespace {

/// Mean of the errors of the goals of one kind that each hand has reached.
template <class Goal>
class Errors {
 public:
  void find(const Simulation& simulation) { goals_ = simulation.scene().all<Goal>(); }
  template <class Q>
  void put_into(Metric<Q>& metric) const {
    for (const int hand : {left_hand, right_hand, both_hands}) metric.set(hand, mean(hand));
  }
  double mean(int hand) const {
    double sum = 0;
    int n = 0;
    for (const Goal* goal : goals_) {
      if (!goal->reached() || (hand != both_hands && goal->hand_index() != hand)) continue;
      sum += goal->mean_deviation();
      ++n;
    }
    return n > 0 ? sum / n : std::nan("");
  }

 private:
  std::vector<Goal*> goals_;
};

class SkillMetrics final : public MetricSet {
 public:
  Metric<Length> touch_error{this,
                             {.name = "touch_error",
                              .doc = "Mean distance from the middle of the targets",
                              .source = "Insula",
                              .better = Better::low,
                              .display = "mm",
                              .digits = 2}};
  Metric<Force> force_error{this,
                            {.name = "force_error",
                             .doc = "Mean deviation from the middle of the force's band",
                             .source = "Insula",
                             .better = Better::low,
                             .display = "mN",
                             .digits = 1}};
  Metric<Length> clip_error{this,
                            {.name = "clip_error",
                             .doc = "Mean distance of the clip from its mark",
                             .source = "Insula",
                             .better = Better::low,
                             .of = Of::both_hands,
                             .display = "mm",
                             .digits = 2}};

  void declare(PrepareContext&, const Simulation& simulation) override {
    clips_.find(simulation);
    touches_.find(simulation);
    forces_.find(simulation);
  }
  void observe(const StepReport&) override {}  // the goals have seen it
  void evaluate() override {
    touches_.put_into(touch_error);
    forces_.put_into(force_error);
    clip_error.set(clips_.mean(both_hands));
  }
  void reset() override {}

 private:
  Errors<GoalTouch> touches_;
  Errors<GoalHoldForce> forces_;
  Errors<GoalClipPlaced> clips_;
};

}  // namespace
}  // namespace insula

INSULA_PLUGIN(skill_rules) {
  using namespace insula;
  registry.add_material({"place_waiting", "place", {0.50, 0.55, 0.60, 1}, 0.6, 0, 0});
  registry.add_material({"place_of_left_hand", "place", {0.16, 0.55, 0.95, 1}, 0.35, 0, 0});
  registry.add_material({"place_of_right_hand", "place", {1.0, 0.55, 0.10, 1}, 0.35, 0, 0});
  registry.add_material({"place_reached", "solid", {0.30, 0.72, 0.38, 1}, 0.5, 0, 0});
  registry.add_material({"place_reading", "solid", {1, 1, 1, 1}, 0.5, 0, 0});
  registry.add<GoalTouch>("goal_touch", Kind::exercise_rule, "reached when the tip of a hand has touched a target");
  registry.add<GoalHoldForce>("goal_hold_force", Kind::exercise_rule,
                              "reached when a hand has held a force within a band");
  registry.add<GoalClipPlaced>("goal_clip_placed", Kind::exercise_rule,
                               "reached when a clip has been let go at a marked place of a tube");
  registry.add<SkillMetrics>("skill_metrics", Kind::metric, "how exactly the goals of a skill task were reached");
}
