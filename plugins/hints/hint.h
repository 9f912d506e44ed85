// SPDX-License-Identifier: GPL-3.0-or-later
// What all hints share: their words, the tool that they point at, and how near they are to their cue.
#pragma once
#include <cmath>
#include <string>

#include "core/sim/exercise.h"
#include "core/sim/simulation.h"
#include "plugins/hints/cue_choice.h"

namespace insula {

/// What a hint finds in a step.
struct HintReading {
  double share = std::nan("");  ///< of the way to the limit; NaN: nothing is known
  double value = std::nan("");  ///< of what it watches
  double limit = std::nan("");
  int hand = -1;             ///< whose value it is
  std::size_t which = 0;     ///< of several things that it watches
  Vec3 away = Vec3::Zero();  ///< leads the hand away from the fault; zero: against its force on tissue
};

/// A rule that says something before a limit is passed. The tutor of the exercise asks it in each step.
class Hint : public ExerciseRule {
 public:
  static constexpr std::string_view kind_name = "hint";
  Param<std::string> text{this, {.name = "text", .doc = "what the trainee is told"}};
  Param<Choice> at{this,
                   {.name = "at",
                    .fallback = "cause",
                    .choices = {"cause", "left", "right", "none"},
                    .doc = "the hand whose tool an arrow points at; cause: the hand whose value it is, if any"}};
  Param<Vec<Scalar>> away{this,
                          {.name = "away",
                           .fallback = "0 0 0",
                           .doc = "direction in which a soft force draws the hand; 0 0 0: where the hint knows, or "
                                  "against the force of the hand on what it touches"}};
  Param<Scalar> warning{this,
                        {.name = "warning",
                         .fallback = "1",
                         .min = "0.05",
                         .max = "1",
                         .doc = "share of the way to the limit at which the hint comes; 1: at the limit"}};
  Param<Duration> hold{
      this, {.name = "hold", .fallback = "0 s", .min = "0 s", .max = "60 s", .doc = "for how long it must be so"}};

  Channel<Scalar> share{this,
                        {.name = "share",
                         .doc = "share of the way to the limit; 1: at the limit",
                         .shown = Shown::none,
                         .display = "%",
                         .digits = 0}};

  void declare(PrepareContext& context, const Simulation& simulation, ExerciseLog&) override {
    if (!has_tutor()) error(context, "needs a <tutor> in its exercise, which gives the cues");
    find(context, simulation);
  }
  /// The tutor calls look() in its place, so that it does not matter who stands first.
  void observe(const StepReport&, ExerciseLog&) override {}
  HintNow look(const StepReport& report) {
    now_ = read(report);
    share.set(now_.share);
    return {now_.share, warning(), hold(), urgent()};
  }
  void reset() override {
    now_ = {};
    share.set(now_.share);
  }
  const HintReading& now() const { return now_; }
  /// Unit, scene frame: leads the hand away from the fault; zero: no direction is known.
  Vec3 direction(const StepReport& report) const {
    Vec3 out = !away().isZero(0) ? away() : now_.away;
    if (const int of = hand(); out.isZero(0) && of >= 0)
      for (const StructureForce& s : report.structures) out -= s.of_hand[std::size_t(of)];
    const double size = out.norm();
    return size > 0 ? Vec3(out / size) : Vec3(Vec3::Zero());
  }
  int hand() const { return at.is("left") ? 0 : at.is("right") ? 1 : at.is("none") ? -1 : now_.hand; }

  /// Name of what it watches: a channel or a metric.
  virtual std::string watched() const = 0;
  /// A value of it as people read it, with its unit.
  virtual std::string worded(double value) const = 0;

  /// Whether it tells of a fault that is near. Those go first.
  virtual bool urgent() const { return true; }

 protected:
  virtual void find(PrepareContext& context, const Simulation& simulation) = 0;
  virtual HintReading read(const StepReport& report) = 0;

 private:
  bool has_tutor() const;
  HintReading now_;
};

}  // namespace insula
