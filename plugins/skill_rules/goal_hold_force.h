// SPDX-License-Identifier: GPL-3.0-or-later
// A force within a band that one hand must hold at a marked place of a soft body.
#pragma once
#include "plugins/skill_rules/ring.h"
#include "plugins/skill_rules/skill_goal.h"

namespace insula {

/// A label that is not always there.
class Reading final : public DrawableBase {
 public:
  Reading(Component* owner, DrawableSpec spec) : DrawableBase(owner, spec, DrawableKind::label) {}
  void set(const Vec3& p, double value) {
    resize_elements(1);
    put(0, p, value);
  }
  void clear() { resize_elements(0); }
};

class GoalHoldForce final : public SkillGoal {
 public:
  Ref<Body> on{this, {.name = "on", .doc = "body that is pressed or pulled"}};
  Param<Force> least{
      this, {.name = "least", .min = "0.1 mN", .max = "20 N", .doc = "smallest force of the hand that is good"}};
  Param<Force> most{this, {.name = "most", .min = "0.1 mN", .max = "20 N", .doc = "largest force that is good"}};
  Param<Vec<Scalar>> normal{
      this, {.name = "normal", .fallback = "0 0 1", .doc = "out of the surface; the ring lies across it"}};

  Channel<Force> force{this,
                       {.name = "force",
                        .doc = "of the hand at the marked place, in its turn",
                        .min = "0 N",
                        .shown = Shown::curve,
                        .display = "mN",
                        .digits = 0}};

  Marks<Polylines> ring{this, "0.3 mm", ring_points};
  Polylines held{this,
                 {.name = "held",
                  .doc = "part of a ring: the share of the hold that is done",
                  .material = "place_reached",
                  .value = "share of the hold that is done",
                  .radius = "0.4 mm",
                  .points_per_line = ring_points}};
  Reading reading{this,
                  {.name = "reading",
                   .doc = "the force in its turn, to 5 mN",
                   .material = "place_reading",
                   .value = "force",
                   .unit = "N"}};

  void prepare(PrepareContext& context) override {
    SkillGoal::prepare(context);
    if (normal().norm() < 1e-9) error(context, normal, "a direction must not be zero");
    if (!(least() < most())) error(context, most, "must be above least");
  }
  void declare(PrepareContext& context, const Simulation& simulation, ExerciseLog& log) override {
    SkillGoal::declare(context, simulation, log);
    structure_ = std::size_t(std::max(0, structure_of(context, simulation, on, *on)));
  }
  void publish() override {
    SkillGoal::publish();
    force.set(turn() ? now_ : std::nan(""));
    if (turn() && now_ >= 0) reading.set(at() + 0.012 * normal().normalized(), 0.005 * std::round(now_ / 0.005));
    else reading.clear();
  }
  void reset() override {
    SkillGoal::reset();
    now_ = std::nan("");
  }

 protected:
  void mark(Look look, double share) override {
    draw_ring(ring.only(look), at(), normal(), radius(), 1, share);
    if (look == Look::left || look == Look::right) draw_ring(held, at(), normal(), radius() + 0.8e-3, share, share);
    else held.resize(0);
  }
  bool good(const StepReport& report) override {
    const bool there = distance(report) <= radius();
    now_ = there ? of_hand(report) : 0;
    return there && now_ >= least() && now_ <= most();
  }
  double deviation(const StepReport& report) const override {
    return std::abs(of_hand(report) - 0.5 * (least() + most()));
  }

 private:
  double of_hand(const StepReport& report) const {
    return report.structures[structure_].of_hand[std::size_t(hand_index())].norm();
  }

  std::size_t structure_ = 0;  ///< among those of the report
  double now_ = std::nan("");  ///< N
};

}  // namespace insula
