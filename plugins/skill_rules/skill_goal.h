// SPDX-License-Identifier: GPL-3.0-or-later
// What the goals of skill tasks share: a marked place, the hand that goes there, and the goal that comes before.
#pragma once
#include <algorithm>
#include <array>
#include <cmath>

#include "core/sim/exercise.h"
#include "core/sim/simulation.h"

namespace insula {

/// How a place is drawn: before its turn, in its turn for either hand, and once its goal is reached.
enum class Look { waiting, left, right, reached };

/// A drawable for each look. One of them is shown.
template <class D>
class Marks {
 public:
  /// radius: DrawableSpec::radius, with its unit. points_per_line: of polylines.
  Marks(Component* owner, std::string_view radius, int points_per_line = 2)
      : all_{D(owner, spec("waiting", "the place before its turn", "place_waiting", radius, points_per_line)),
             D(owner, spec("left", "the place while it is the left hand's turn", "place_of_left_hand", radius,
                           points_per_line)),
             D(owner, spec("right", "the place while it is the right hand's turn", "place_of_right_hand", radius,
                           points_per_line)),
             D(owner,
               spec("reached", "the place once the goal is reached", "place_reached", radius, points_per_line))} {}
  D& operator[](Look look) { return all_[std::size_t(look)]; }
  /// The one to be filled; the others show nothing.
  D& only(Look look) {
    for (D& d : all_) d.resize(0);
    return (*this)[look];
  }

 private:
  static DrawableSpec spec(std::string_view name, std::string_view doc, std::string_view material,
                           std::string_view radius, int points_per_line) {
    return {.name = name,
            .doc = doc,
            .material = material,
            .value = "share of the hold that is done",
            .radius = radius,
            .points_per_line = points_per_line};
  }
  std::array<D, 4> all_;
};

/// A place that one hand must attend to. It is drawn in the colour of its hand while its turn is on, pale before, and
/// as reached afterwards.
class SkillGoal : public ExerciseRule {
 public:
  static constexpr std::string_view kind_name = "goal of a skill task";

  Param<std::string> text{this, {.name = "text", .doc = "what the trainee is to do, and with which hand"}};
  Param<Choice> hand{this, {.name = "hand", .choices = {"left", "right"}, .doc = "hand that does it"}};
  Param<Vec<Length>> at{this, {.name = "at", .doc = "middle of the marked place"}};
  Param<Length> radius{this,
                       {.name = "radius",
                        .fallback = "1.2 mm",
                        .min = "0.1 mm",
                        .max = "50 mm",
                        .doc = "the tip is at the place while it is as near as this"}};
  Param<Duration> hold{
      this, {.name = "hold", .fallback = "0.3 s", .min = "0 s", .max = "600 s", .doc = "how long it must last"}};
  Ref<SkillGoal> after{this,
                       {.name = "after", .fallback = "", .doc = "goal that comes first; none: the turn is on at once"}};

  void prepare(PrepareContext& context) override {
    const SkillGoal* g = after.get();
    for (int steps = 0; g && steps < 1000; ++steps) {
      if (g == this) return error(context, after, "comes after itself");
      g = g->after.get();
    }
  }
  void declare(PrepareContext&, const Simulation&, ExerciseLog& log) override { goal_ = log.add_goal(id, text()); }
  void observe(const StepReport& report, ExerciseLog& log) final {
    watch(report, log);
    if (!turn()) return;
    if (!good(report)) return restart();
    held_ += report.h;
    sum_ += report.h * deviation(report);
    if (held_ < hold() - 1e-9) return;
    reached_ = true;
    error_ = sum_ / held_;
    log.goal(goal_, report.time);
  }
  void publish() override { mark(reached_ ? Look::reached : !turn() ? Look::waiting : look_of_hand(), share()); }
  void reset() override {
    restart();
    reached_ = false;
    error_ = std::nan("");
  }

  bool reached() const { return reached_; }
  bool turn() const { return !reached_ && (!after || after->reached()); }  ///< whether it is to be done now
  /// Mean deviation while it was held; NaN until it is reached.
  double mean_deviation() const { return error_; }
  int hand_index() const { return hand.is("right") ? 1 : 0; }

 protected:
  /// Draws the place so. share: of the hold that is done.
  virtual void mark(Look look, double share) = 0;
  /// Whether the condition holds at the end of the step.
  virtual bool good(const StepReport& report) = 0;
  /// Sees every step, whosever turn it is.
  virtual void watch(const StepReport&, ExerciseLog&) {}
  /// Of the step from what would be best.
  virtual double deviation(const StepReport& report) const = 0;
  /// Distance of the hand's tip from the place; infinite without a tool, m.
  double distance(const StepReport& report) const {
    const HandReport& h = report.hands[std::size_t(hand_index())];
    return h.tool ? (h.tip.p - at()).norm() : infinite;
  }
  /// Among the structures of the report; reports an error at `on` for what is none.
  int structure_of(PrepareContext& context, const Simulation& simulation, const ParamBase& on, const Body& body) const {
    const auto& all = simulation.report().structures;
    for (std::size_t i = 0; i < all.size(); ++i)
      if (all[i].body == &body) return int(i);
    error(context, on, "names a tool or an implant, not something that is touched");
    return -1;
  }

 private:
  void restart() { held_ = sum_ = 0; }
  double share() const { return hold() > 0 ? std::min(1.0, held_ / hold()) : 0; }
  Look look_of_hand() const { return hand.is("left") ? Look::left : Look::right; }

  int goal_ = 0;
  double held_ = 0, sum_ = 0;  ///< s; s times the unit of the deviation
  double error_ = std::nan("");
  bool reached_ = false;
};

}  // namespace insula
