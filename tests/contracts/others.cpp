// SPDX-License-Identifier: GPL-3.0-or-later
// Supports, conditions, exercise rules, metrics and instruments with one mistake each.
#include <algorithm>

#include "core/constraint/stated_law.h"
#include "core/mechanics/deformable_body.h"
#include "core/mechanics/force_model.h"
#include "core/mechanics/instrument.h"
#include "core/sim/simulation.h"
#include "tests/contracts/mistakes.h"

namespace insula::mistakes {
namespace {

enum class Held { right, nothing, lets_go };

template <Held H>
class Hold final : public Support {
 public:
  void fix(PrepareContext&, const std::vector<Vec3>& rest, std::vector<char>& held) override {
    double low = rest[0].z();
    for (const Vec3& x : rest) low = std::min(low, x.z());
    for (std::size_t i = 0; i < rest.size(); ++i) {
      if (H == Held::lets_go) held[i] = rest[i].z() < low + 1e-6;
      else if (H == Held::right && rest[i].z() < low + 1e-6) held[i] = 1;
    }
  }
};

enum class Kept { right, everything, more };

/// Keeps the half of the body with x >= 0.
template <Kept K>
class Keep final : public Condition {
 public:
  void restrict(PrepareContext&, const std::vector<Vec3>& rest, std::vector<char>& chosen) override {
    for (std::size_t i = 0; i < rest.size(); ++i) {
      if (K != Kept::everything && rest[i].x() < 0) chosen[i] = 0;
      else if (K == Kept::more) chosen[i] = 1;
    }
  }
};

enum class Judged { right, one_id, forgets_reset, writes };

/// Reached when ten steps have passed; a measure counts them.
template <Judged J>
class Rule final : public ExerciseRule {
 public:
  void declare(PrepareContext&, const Simulation& s, ExerciseLog& log) override {
    simulation_ = &s;
    goal_ = log.add_goal(id, "wait");
    if (J == Judged::one_id) log.add_goal(id, "wait again");
    measure_ = log.add_measure(id + "_count", "steps", "1");
    timer_ = log.add_timer(id + "_time", "time", 0);
  }
  void observe(const StepReport& r, ExerciseLog& log) override {
    if (++count_ >= 10) log.goal(goal_, r.time);
    log.measure(measure_, count_, 0);
    log.timer(timer_, r.time, true);
    if (J != Judged::writes) return;
    for (Body* b : simulation_->bodies())
      if (auto* soft = dynamic_cast<DeformableBody*>(b)) soft->v() *= 0.999;
  }
  void reset() override {
    if (J != Judged::forgets_reset) count_ = 0;
  }

 private:
  const Simulation* simulation_ = nullptr;
  int goal_ = 0, measure_ = 0, timer_ = 0, count_ = 0;
};

enum class Counted { right, forgets_reset, changes_by_evaluation, one_id };

/// The time of the run.
template <Counted C>
class Count final : public MetricSet {
 public:
  Metric<Duration> time{this, {.name = "time", .doc = "time", .source = "tests", .of = Of::both_hands}};
  MetricGroup<Duration> each{this, {.name = "each", .doc = "time", .source = "tests", .of = Of::both_hands}};
  void declare(PrepareContext&, const Simulation&) override {
    if (C == Counted::one_id) each.declare_items({"a", "a"});
  }
  void observe(const StepReport& r) override { sum_ += r.h; }
  void evaluate() override {
    time.set(sum_);
    if (C == Counted::changes_by_evaluation) sum_ *= 1.01;
  }
  void reset() override {
    if (C != Counted::forgets_reset) sum_ = 0;
  }

 private:
  double sum_ = 0;
};

enum class Tool { right, busy, follows_badly, forgets_reset, weak_law };

/// An instrument that pulls itself home by a spring while it is in the hand.
template <Tool T>
class Probe final : public Instrument, public StatesLaw {
 public:
  double activity() const override { return T == Tool::busy ? 1.5 : 0; }
  void free_motion(const StepContext& context) override {
    if (T == Tool::follows_badly) {  // behind the hand by a tenth of a millimetre
      HandState late = state();
      late.device.p.x() += 1e-4;
      set_hand(late);
    }
    Instrument::free_motion(context);
  }
  void build(const StepContext&, ConstraintBuilder& builder) override {
    const Vec3 d = pose().p - home_pose().p;
    if (d.norm() < 1e-9 || d.norm() > 0.05) return;
    Block block;
    block.id = row_id(*this, 0);
    block.compliance = 1 / stiffness();
    const int row = builder.add(block);
    builder.violation(row, d.norm());
    builder.point(row, link_point(0, Vec3::Zero()), d.normalized());
  }
  void finish(const StepContext&, const ConstraintSolution&) override { worn_ = std::min(0.5, worn_ + 0.01); }
  void reset() override {
    Instrument::reset();
    if (T != Tool::forgets_reset) worn_ = 0;
  }
  void append_state(std::vector<double>& out) const override {
    Instrument::append_state(out);
    out.push_back(worn_);
  }
  StatedLaw law() const override {
    const double d = (pose().p - home_pose().p).norm();
    if (d < 1e-9 || d > 0.05) return StatedLaw::potential(0);
    return StatedLaw::potential((T == Tool::weak_law ? 0.4 : 0.5) * stiffness() * d * d);
  }

 private:
  double stiffness() const { return 5 * (1 - worn_); }  // N/m
  double worn_ = 0;
};

}  // namespace

void add_others(Registry& registry) {
  registry.add<Hold<Held::right>>("hold", Kind::support, "support for tests");
  registry.add<Hold<Held::nothing>>("hold_nothing", Kind::support, "support for tests");
  registry.add<Hold<Held::lets_go>>("hold_lets_go", Kind::support, "support for tests");
  registry.add<Keep<Kept::right>>("keep", Kind::condition, "condition for tests");
  registry.add<Keep<Kept::everything>>("keep_everything", Kind::condition, "condition for tests");
  registry.add<Keep<Kept::more>>("keep_more", Kind::condition, "condition for tests");
  registry.add<Rule<Judged::right>>("rule", Kind::exercise_rule, "rule for tests");
  registry.add<Rule<Judged::one_id>>("rule_one_id", Kind::exercise_rule, "rule for tests");
  registry.add<Rule<Judged::forgets_reset>>("rule_forgets_reset", Kind::exercise_rule, "rule for tests");
  registry.add<Rule<Judged::writes>>("rule_writes", Kind::exercise_rule, "rule for tests");
  registry.add<Count<Counted::right>>("metric", Kind::metric, "metric for tests");
  registry.add<Count<Counted::forgets_reset>>("metric_forgets_reset", Kind::metric, "metric for tests");
  registry.add<Count<Counted::changes_by_evaluation>>("metric_changes_by_evaluation", Kind::metric, "metric for tests");
  registry.add<Count<Counted::one_id>>("metric_one_id", Kind::metric, "metric for tests");
  registry.add<Probe<Tool::right>>("probe", Kind::instrument, "instrument for tests");
  registry.add<Probe<Tool::busy>>("probe_busy", Kind::instrument, "instrument for tests");
  registry.add<Probe<Tool::follows_badly>>("probe_follows_badly", Kind::instrument, "instrument for tests");
  registry.add<Probe<Tool::forgets_reset>>("probe_forgets_reset", Kind::instrument, "instrument for tests");
  registry.add<Probe<Tool::weak_law>>("probe_weak_law", Kind::instrument, "instrument for tests");
}

}  // namespace insula::mistakes
