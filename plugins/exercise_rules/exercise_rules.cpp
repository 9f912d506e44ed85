// SPDX-License-Identifier: GPL-3.0-or-later
/*
# exercise_rules

Goals, faults and the clock of training exercises. Rules read the report of each step, channels, and the positions of
surfaces; they write to the exercise's log alone.

A force fault counts once each time a hand presses or pulls a body harder than the limit for longer than the grace time.
The force of a hand is that of its tool and of all that the tool holds, such as a clip. It can count again when the
force has fallen below nine tenths of the limit. An order fault counts a strand that was severed
while more than the allowed number of strands nearer to the surface remained.
*/
#include <algorithm>
#include <array>
#include <cmath>

#include "core/base/text.h"
#include "core/registry/registry.h"
#include "core/sim/exercise.h"
#include "core/sim/simulation.h"
#include "core/sim/watched_limit.h"
#include "plugins/exercise_rules/register.h"
#include "plugins/strand_springs/strand_set.h"

namespace insula {
namespace {

class GoalStrands final : public ExerciseRule {
 public:
  Param<std::string> text{
      this, {.name = "text", .fallback = "Divide the arachnoid strands", .doc = "what the trainee is to do"}};
  Param<Scalar> fraction{this,
                         {.name = "fraction",
                          .fallback = "1",
                          .min = "0.01",
                          .max = "1",
                          .doc = "share of all strands that must be parted"}};

  Channel<Scalar> divided{this,
                          {.name = "divided",
                           .doc = "Strands divided",
                           .min = "0",
                           .max = "1",
                           .shown = Shown::none,
                           .display = "%",
                           .digits = 0,
                           .measure = true}};
  Points left_over{this,
                   {.name = "left_over",
                    .doc = "middle of each strand that stands, once a fifth of those to be parted or fewer are left",
                    .material = "aim",
                    .value = "integrity of the strand",
                    .radius = "0.25 mm"}};

  void prepare(PrepareContext&) override { divided.set_bands({fraction(), std::nullopt}, {0.0, std::nullopt}); }
  void declare(PrepareContext&, const Simulation& simulation, ExerciseLog& log) override {
    strands_ = Strands(simulation);
    goal_ = log.add_goal(id, text());
  }
  void observe(const StepReport& r, ExerciseLog& log) override {
    const int total = strands_.total(), severed = total - strands_.left();
    if (total > 0) divided.set(double(severed) / total);
    if (total > 0 && severed >= fraction() * total - 1e-9) log.goal(goal_, r.time);
  }
  void publish() override {
    const int total = strands_.total(), left = strands_.left();
    const double wanted = fraction() * total, missing = wanted - (total - left);
    const bool few = missing > 1e-9 && missing <= 0.2 * wanted;
    left_over.resize(few ? std::size_t(left) : 0);
    if (!few) return;
    std::size_t k = 0;
    for (const StrandState& s : strands_.now())
      if (s.integrity >= 0) left_over.set(k++, 0.5 * (s.a + s.b), s.integrity);
  }

 private:
  Strands strands_;
  int goal_ = 0;
};

// Two surfaces held apart at a place: the distance of the two vertices that are nearest to it at rest.
class GoalOpening final : public ExerciseRule {
 public:
  Param<std::string> text{this, {.name = "text", .fallback = "Open the fissure", .doc = "what the trainee is to do"}};
  Ref<Surface> a{this, {.name = "a", .doc = "one lip"}};
  Ref<Surface> b{this, {.name = "b", .doc = "the other lip"}};
  Param<Vec<Length>> at{this, {.name = "at", .doc = "place between the lips at rest"}};
  Param<Length> distance{this,
                         {.name = "distance",
                          .fallback = "4 mm",
                          .min = "0.1 mm",
                          .max = "100 mm",
                          .doc = "distance of the lips that counts as open"}};
  Param<Duration> hold{
      this, {.name = "hold", .fallback = "1 s", .min = "0 s", .max = "600 s", .doc = "how long they must stay open"}};

  Channel<Length> opening{this,
                          {.name = "opening",
                           .doc = "Largest distance of the lips",
                           .min = "0 mm",
                           .shown = Shown::none,
                           .display = "mm",
                           .digits = 1,
                           .measure = true}};
  Channel<Length> gap{this,
                      {.name = "gap",
                       .doc = "Present distance of the lips",
                       .min = "0 mm",
                       .shown = Shown::none,
                       .display = "mm",
                       .digits = 1}};

  void prepare(PrepareContext&) override { opening.set_bands({distance(), std::nullopt}, {0.0, std::nullopt}); }
  void declare(PrepareContext&, const Simulation&, ExerciseLog& log) override {
    goal_ = log.add_goal(id, text());
    va_ = nearest(*a);
    vb_ = nearest(*b);
  }
  void observe(const StepReport& r, ExerciseLog& log) override {
    const double d = (a->body().position(a->points()[va_]) - b->body().position(b->points()[vb_])).norm();
    widest_ = std::max(widest_, d);
    opening.set(widest_);
    gap.set(d);
    open_ = d >= distance() ? open_ + r.h : 0;
    if (open_ >= hold()) log.goal(goal_, r.time);
  }
  void reset() override { open_ = widest_ = 0; }

 private:
  std::size_t nearest(const Surface& s) const {
    std::size_t best = 0;
    for (std::size_t i = 1; i < s.rest().vertices.size(); ++i)
      if ((s.rest().vertices[i] - at()).squaredNorm() < (s.rest().vertices[best] - at()).squaredNorm()) best = i;
    return best;
  }
  int goal_ = 0;
  std::size_t va_ = 0, vb_ = 0;
  double open_ = 0, widest_ = 0;
};

class FaultForce final : public ExerciseRule, public WatchesLimits {
 public:
  Param<std::string> text{
      this, {.name = "text", .fallback = "Too much force on the brain", .doc = "what the trainee is told"}};
  RefList<Body> on{this, {.name = "on", .doc = "tissue, floor or bone that must be spared"}};
  Param<Force> limit{this,
                     {.name = "limit",
                      .fallback = "0.3 N",
                      .min = "0.001 N",
                      .max = "20 N",
                      .doc = "largest force of one hand, with its tool and all that it holds, on one body"}};
  Param<Duration> grace{
      this, {.name = "grace", .fallback = "100 ms", .min = "0 s", .max = "10 s", .doc = "shorter peaks are forgiven"}};

  ChannelGroup<Force> force{this,
                            {.name = "force",
                             .doc = "of the hand, the largest on one of the bodies",
                             .min = "0 N",
                             .shown = Shown::none,
                             .display = "mN",
                             .digits = 0}};

  void prepare(PrepareContext&) override { force.declare({"left", "right"}); }
  void declare(PrepareContext& context, const Simulation& simulation, ExerciseLog& log) override {
    fault_ = log.add_fault(id, text());
    const auto& structures = simulation.report().structures;
    structure_.clear();
    for (const Body* body : on()) {
      const auto found =
          std::find_if(structures.begin(), structures.end(), [&](const StructureForce& s) { return s.body == body; });
      if (found == structures.end())
        return error(context, on, in_quotes(body->id) + " is a tool or an implant, not tissue, floor or bone");
      structure_.push_back(std::size_t(found - structures.begin()));
    }
    reset();
  }
  void observe(const StepReport& r, ExerciseLog& log) override {
    std::array<double, 2> largest{};
    for (std::size_t k = 0; k < watch_.size(); ++k) {
      const double f = r.structures[structure_[k / 2]].of_hand[k % 2].norm();
      largest[k % 2] = std::max(largest[k % 2], f);
      Watch& w = watch_[k];
      w.above = f > limit() ? w.above + r.h : 0;
      if (w.above > grace() && w.armed) {
        w.armed = false;
        log.fault(fault_, r.time, f);
      }
      if (f < 0.9 * limit()) w.armed = true;
    }
    for (std::size_t hand = 0; hand < 2; ++hand) force.set(hand, largest[hand]);
  }
  std::vector<WatchedLimit> watched_limits() const override {
    std::vector<WatchedLimit> out;
    for (int hand = 0; hand < 2; ++hand) out.push_back({&force, std::size_t(hand), this, limit(), true, hand});
    return out;
  }
  void reset() override {
    watch_.assign(2 * structure_.size(), {});
    force.reset();
  }

 private:
  struct Watch {
    double above = 0;
    bool armed = true;
  };
  int fault_ = 0;
  std::vector<std::size_t> structure_;  ///< among those of the report
  std::vector<Watch> watch_;            ///< of each structure: left hand, right hand
};

class FaultTorn final : public ExerciseRule, public WatchesLimits {
 public:
  Param<std::string> text{
      this, {.name = "text", .fallback = "A strand was torn instead of cut", .doc = "what the trainee is told"}};
  void declare(PrepareContext&, const Simulation& simulation, ExerciseLog& log) override {
    fault_ = log.add_fault(id, text());
    sets_ = simulation.scene().all<StrandSet>();
  }
  void observe(const StepReport& r, ExerciseLog& log) override {
    for (const Event& e : r.events)
      if (e.kind == "strand_torn") log.fault(fault_, r.time, e.value);
  }
  std::vector<WatchedLimit> watched_limits() const override {
    std::vector<WatchedLimit> out;
    for (const StrandSet* set : sets_)
      if (const ChannelBase* load = set->load_channel())
        out.push_back({load, 0, dynamic_cast<const Component*>(set), 1});
    return out;
  }

 private:
  std::vector<StrandSet*> sets_;
  int fault_ = 0;
};

class FaultOrder final : public ExerciseRule {
 public:
  Param<std::string> text{
      this, {.name = "text", .fallback = "Work from the surface to the depth", .doc = "what the trainee is told"}};
  Param<Vec<Scalar>> inward{this, {.name = "inward", .doc = "direction from the surface to the depth"}};
  Param<Length> margin{this,
                       {.name = "margin",
                        .fallback = "4 mm",
                        .min = "0 mm",
                        .max = "100 mm",
                        .doc = "strands this much nearer to the surface come first"}};
  Param<int> allowed{
      this,
      {.name = "allowed", .fallback = "3", .min = "0", .max = "100000", .doc = "that many of them may still stand"}};

  void prepare(PrepareContext& context) override {
    if (inward().norm() < 1e-9) error(context, inward, "inward: a direction must not be zero");
  }
  void declare(PrepareContext&, const Simulation& simulation, ExerciseLog& log) override {
    strands_ = Strands(simulation);
    fault_ = log.add_fault(id, text());
  }
  void observe(const StepReport& r, ExerciseLog& log) override {
    const std::vector<char>& now = strands_.severed();
    if (depth_.size() != now.size()) {  // first step: depths at the start
      depth_.clear();
      for (const StrandState& s : strands_.now()) depth_.push_back(0.5 * (s.a + s.b).dot(inward().normalized()));
      severed_.assign(now.size(), 0);
    }
    for (std::size_t i = 0; i < now.size(); ++i) {
      if (severed_[i] || !now[i]) continue;
      severed_[i] = 1;
      int before = 0;
      for (std::size_t k = 0; k < now.size(); ++k)
        before += !severed_[k] && !now[k] && depth_[k] < depth_[i] - margin();
      if (before > allowed()) log.fault(fault_, r.time, before);
    }
  }
  void reset() override { depth_.clear(); }

 private:
  Strands strands_;
  int fault_ = 0;
  std::vector<double> depth_;
  std::vector<char> severed_;
};

class TimeLimit final : public ExerciseRule {
 public:
  Param<std::string> text{this, {.name = "text", .fallback = "The time is over", .doc = "what the trainee is told"}};
  Param<Duration> limit{
      this, {.name = "limit", .min = "1 s", .max = "7200 s", .doc = "simulated time until the exercise has failed"}};
  void declare(PrepareContext&, const Simulation&, ExerciseLog&) override {}
  void observe(const StepReport& r, ExerciseLog& log) override {
    if (r.time > limit()) log.fail(text(), r.time);
  }
};

}  // namespace
}  // namespace insula

INSULA_PLUGIN(exercise_rules) {
  using namespace insula;
  registry.add_material({"aim", "aim", {0.39, 1, 0.82, 0.6}, 0.5, 0, 0});
  registry.add_material({"goal_place", "place", {0.39, 1, 0.82, 1}, 0.5, 0, 0});
  registry.add<GoalStrands>("goal_strands", Kind::exercise_rule, "reached when enough strands are severed");
  registry.add<GoalOpening>("goal_opening", Kind::exercise_rule, "reached when two surfaces are held apart");
  registry.add<FaultForce>("fault_force", Kind::exercise_rule, "counts too much force of a tool on a body");
  registry.add<FaultTorn>("fault_torn", Kind::exercise_rule, "counts strands torn by pulling");
  registry.add<FaultOrder>("fault_order", Kind::exercise_rule, "counts strands cut in the depth before the surface");
  register_channel_rules(registry);
  register_event_rules(registry);
  register_two_hands_rule(registry);
  registry.add<TimeLimit>("time_limit", Kind::exercise_rule, "ends the exercise when the time is over");
}
