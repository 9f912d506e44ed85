// SPDX-License-Identifier: GPL-3.0-or-later
/*
# @name@

A goal: a tool's tip stays within `distance` of a place for `hold`. Each time that it leaves the place too soon counts
as a fault. A rule reads the report and positions, and writes to the exercise's log alone: it never changes the
simulation.
*/
#include <algorithm>

#include "core/registry/registry.h"
#include "core/sim/exercise.h"
#include "core/sim/simulation.h"

namespace insula {
namespace {

class @Name@ final : public ExerciseRule {
 public:
  Param<std::string> text{
      this, {.name = "text", .fallback = "Hold the tip at the place", .doc = "what the trainee is to do"}};
  Param<Vec<Length>> at{this, {.name = "at", .doc = "the place, scene frame"}};
  Param<Length> distance{this,
                         {.name = "distance",
                          .fallback = "1 mm",
                          .min = "0.01 mm",
                          .max = "100 mm",
                          .doc = "of the tip from the place that is near enough"}};
  Param<Duration> hold{
      this, {.name = "hold", .fallback = "2 s", .min = "0 s", .max = "600 s", .doc = "how long it must stay there"}};

  // Once: find what is watched; declare goals and faults, so that viewers and reports know them from the start.
  void declare(PrepareContext& context, const Simulation& simulation, ExerciseLog& log) override {
    tools_ = simulation.instruments();
    if (tools_.empty()) error(context, "watches a tool, and the scene has none");
    goal_ = log.add_goal(id, text());
    fault_ = log.add_fault(id + "_left", "The tip left the place too soon");
  }
  // Every step.
  void observe(const StepReport& report, ExerciseLog& log) override {
    const bool near = std::any_of(tools_.begin(), tools_.end(), [&](const Instrument* t) {
      return t->active() && (t->pose().p - at()).norm() <= distance();
    });
    if (!near && near_for_ > 0 && near_for_ < hold()) log.fault(fault_, report.time, near_for_);
    near_for_ = near ? near_for_ + report.h : 0;
    if (near && near_for_ >= hold() - 1e-9) log.goal(goal_, report.time);
  }
  void reset() override { near_for_ = 0; }

 private:
  std::vector<Instrument*> tools_;
  int goal_ = 0, fault_ = 0;
  double near_for_ = 0;  // s
};

}  // namespace
}  // namespace insula

INSULA_PLUGIN(@name@) { registry.add<insula::@Name@>("@name@", insula::Kind::exercise_rule, "@doc@"); }
