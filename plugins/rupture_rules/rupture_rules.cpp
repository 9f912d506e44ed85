// SPDX-License-Identifier: GPL-3.0-or-later
/*
# rupture_rules

Goals and clocks of an intraoperative rupture.

- `fault_rupture` counts a rupture (one that the trainee caused, or any).
- `goal_bleeding_stopped` is reached when a tear, once open, has let out no more than `rate` for `hold`.
- `timer_rupture` runs from the rupture until a permanent clip is on and the bleeding has stopped. Beyond `limit` the
  exercise has failed.
- `timer_temporary_clip` runs while a temporary clip is on, released or held shut on the vessel. Beyond `limit` it
  counts a fault (three minutes: longer occlusion risks a stroke).
- `goal_temporary_removed` is reached when a temporary clip that was on is off again, with a permanent clip on and no
  bleeding.

Blood comes with the pulse, and a tear that is nearly shut spurts now and then. A single step's rate therefore does
not withdraw a reached goal; only continuing bleeding does. With r the rate of bleeding, the surplus

    S <- min(R, max(0, S + (r - rate) h)),   R = rate . 1 s

fills up to R while it bleeds and empties while it does not. The state is "bleeding" from S = R until S = 0. This is a
cumulative sum with hysteresis (E. Page, Continuous inspection schemes, Biometrika 1954).
*/
#include <algorithm>

#include "core/registry/registry.h"
#include "core/sim/exercise.h"
#include "core/sim/simulation.h"
#include "core/sim/watched_limit.h"
#include "plugins/bleeding/bleeding_state.h"
#include "plugins/clip/clip_state.h"

namespace insula {
namespace {

/// Input of these rules: the present clips and bleedings of the scene.
class Patient {
 public:
  Patient() = default;
  explicit Patient(const Simulation& simulation) : clips_(simulation), bleedings_(simulation) {}
  /// Occludes, whether an applier still holds it or not.
  bool temporary_on() {
    return any([](const ClipState& c) { return c.temporary && c.is_on(); });
  }
  /// Stays when the hand goes.
  bool permanent_released() {
    return any([](const ClipState& c) { return !c.temporary && !c.on_tray && !c.holder; });
  }
  double bleeding_rate() {
    double rate = 0;
    for (const BleedingState& b : bleedings_.now()) rate += b.rate;
    return rate;
  }
  /// Simulated time of the first rupture, s; -1: none.
  double ruptured_at() {
    double at = -1;
    for (const BleedingState& b : bleedings_.now())
      if (b.since >= 0 && (at < 0 || b.since < at)) at = b.since;
    return at;
  }

 private:
  bool any(bool (*which)(const ClipState&)) {
    const auto& clips = clips_.now();
    return std::any_of(clips.begin(), clips.end(), which);
  }

  Clips clips_;
  Bleedings bleedings_;
};

/// The flow below which rules count no bleeding.
struct StoppedRate : Param<FlowRate> {
  explicit StoppedRate(ParamSet* owner)
      : Param(owner, {.name = "rate",
                      .fallback = "1 ml/min",
                      .min = "0 ml/min",
                      .max = "1000 ml/min",
                      .doc = "bleeding that counts as none"}) {}
};

/// Whether blood flows, averaged over beats.
class Running {
 public:
  bool observe(double h, double now, double rate) {
    const double full = rate * 1.0;  // of a second
    surplus_ = std::clamp(surplus_ + (now - rate) * h, 0.0, full);
    const bool over = now > rate && surplus_ >= full, none = surplus_ <= 0 && now <= rate;
    runs_ = over || (runs_ && !none);
    return runs_;
  }

 private:
  double surplus_ = 0;  ///< m3
  bool runs_ = false;
};

class FaultRupture final : public ExerciseRule {
 public:
  Param<std::string> text{this,
                          {.name = "text", .fallback = "The aneurysm has ruptured", .doc = "what the trainee is told"}};
  Param<bool> fails{this, {.name = "fails", .fallback = "false", .doc = "whether the exercise ends with it"}};
  void declare(PrepareContext&, const Simulation&, ExerciseLog& log) override { fault_ = log.add_fault(id, text()); }
  void observe(const StepReport& r, ExerciseLog& log) override {
    for (const Event& e : r.events) {
      if (e.kind != "rupture") continue;
      log.fault(fault_, r.time, e.value);
      if (fails()) log.fail(text(), r.time);
    }
  }

 private:
  int fault_ = 0;
};

class GoalBleedingStopped final : public ExerciseRule {
 public:
  Param<std::string> text{this, {.name = "text", .fallback = "Stop the bleeding", .doc = "what the trainee is to do"}};
  StoppedRate rate{this};
  Param<Duration> hold{
      this, {.name = "hold", .fallback = "2 s", .min = "0 s", .max = "600 s", .doc = "how long it must stand"}};
  void declare(PrepareContext&, const Simulation& simulation, ExerciseLog& log) override {
    patient_ = Patient(simulation);
    goal_ = log.add_goal(id, text());
  }
  void observe(const StepReport& r, ExerciseLog& log) override {
    const bool runs = running_.observe(r.h, patient_.bleeding_rate(), rate()),
               dry = patient_.ruptured_at() >= 0 && patient_.bleeding_rate() <= rate();
    held_ = dry ? held_ + r.h : 0;
    if (dry && held_ >= hold()) log.goal(goal_, r.time);
    if (!dry && runs && log.goals()[std::size_t(goal_)].done) log.goal_lost(goal_, r.time);
  }
  void reset() override {
    held_ = 0;
    running_ = {};
  }

 private:
  Patient patient_;
  int goal_ = 0;
  double held_ = 0;
  Running running_;
};

/// What a clock shows.
struct Elapsed : Channel<Duration> {
  explicit Elapsed(Component* owner)
      : Channel(owner, {.name = "elapsed",
                        .doc = "time on the clock",
                        .min = "0 s",
                        .shown = Shown::none,
                        .display = "s",
                        .digits = 0}) {}
};

class TimerRupture final : public ExerciseRule, public WatchesLimits {
 public:
  Param<std::string> text{
      this, {.name = "text", .fallback = "From rupture to the final clip", .doc = "what the clock is called"}};
  Param<std::string> over{this,
                          {.name = "over",
                           .fallback = "Too much time has passed since the rupture",
                           .doc = "what the trainee is told when the time is over"}};
  Param<Duration> limit{this,
                        {.name = "limit",
                         .fallback = "300 s",
                         .min = "1 s",
                         .max = "7200 s",
                         .doc = "time until the exercise has failed"}};
  StoppedRate rate{this};

  Elapsed elapsed{this};

  void declare(PrepareContext&, const Simulation& simulation, ExerciseLog& log) override {
    patient_ = Patient(simulation);
    timer_ = log.add_timer(id, text(), limit());
  }
  std::vector<WatchedLimit> watched_limits() const override { return {{&elapsed, 0, this, limit(), true, -1}}; }
  bool watches_now() const override { return runs_; }
  void observe(const StepReport& r, ExerciseLog& log) override {
    const double since = patient_.ruptured_at();
    const bool runs = running_.observe(r.h, patient_.bleeding_rate(), rate());
    if (since < 0) return;
    const bool mastered = patient_.permanent_released() && !patient_.temporary_on() && !runs;
    runs_ = !mastered;
    if (!mastered) elapsed_ = r.time - since;
    elapsed.set(elapsed_);
    log.timer(timer_, elapsed_, !mastered);
    if (elapsed_ > limit()) log.fail(over(), r.time);
  }
  void reset() override {
    elapsed_ = 0;
    elapsed.reset();
    runs_ = false;
    running_ = {};
  }

 private:
  Patient patient_;
  int timer_ = 0;
  double elapsed_ = 0;
  bool runs_ = false;
  Running running_;
};

class TimerTemporaryClip final : public ExerciseRule, public WatchesLimits {
 public:
  Param<std::string> text{this, {.name = "text", .fallback = "Temporary clip", .doc = "what the clock is called"}};
  Param<std::string> over{this,
                          {.name = "over",
                           .fallback = "The temporary clip has been on for too long",
                           .doc = "what the trainee is told when the time is over"}};
  Param<Duration> limit{this,
                        {.name = "limit",
                         .fallback = "180 s",
                         .min = "1 s",
                         .max = "3600 s",
                         .doc = "longest occlusion without a fault"}};

  Elapsed elapsed{this};

  void declare(PrepareContext&, const Simulation& simulation, ExerciseLog& log) override {
    patient_ = Patient(simulation);
    timer_ = log.add_timer(id, text(), limit());
    fault_ = log.add_fault(id + "_over", over());
  }
  void observe(const StepReport& r, ExerciseLog& log) override {
    const bool on = patient_.temporary_on();
    elapsed_ = on ? elapsed_ + r.h : 0;
    elapsed.set(elapsed_);
    log.timer(timer_, elapsed_, on);
    if (!on) warned_ = false;
    if (elapsed_ > limit() && !warned_) {
      warned_ = true;
      log.fault(fault_, r.time, elapsed_);
    }
  }
  std::vector<WatchedLimit> watched_limits() const override { return {{&elapsed, 0, this, limit(), true, -1}}; }
  void reset() override {
    elapsed_ = 0;
    elapsed.reset();
    warned_ = false;
  }

 private:
  Patient patient_;
  int timer_ = 0, fault_ = 0;
  double elapsed_ = 0;
  bool warned_ = false;
};

class GoalTemporaryRemoved final : public ExerciseRule {
 public:
  Param<std::string> text{
      this, {.name = "text", .fallback = "Remove the temporary clip", .doc = "what the trainee is to do"}};
  StoppedRate rate{this};
  void declare(PrepareContext&, const Simulation& simulation, ExerciseLog& log) override {
    patient_ = Patient(simulation);
    goal_ = log.add_goal(id, text());
  }
  void observe(const StepReport& r, ExerciseLog& log) override {
    const bool on = patient_.temporary_on();
    was_on_ = was_on_ || on;
    const bool runs = running_.observe(r.h, patient_.bleeding_rate(), rate());
    const bool good = was_on_ && !on && patient_.permanent_released() && !runs;
    if (good) log.goal(goal_, r.time);
    if (!good && log.goals()[std::size_t(goal_)].done) log.goal_lost(goal_, r.time);
  }
  void reset() override {
    was_on_ = false;
    running_ = {};
  }

 private:
  Patient patient_;
  int goal_ = 0;
  bool was_on_ = false;
  Running running_;
};

}  // namespace
}  // namespace insula

INSULA_PLUGIN(rupture_rules) {
  using namespace insula;
  registry.add<FaultRupture>("fault_rupture", Kind::exercise_rule, "counts ruptures of the aneurysm");
  registry.add<GoalBleedingStopped>("goal_bleeding_stopped", Kind::exercise_rule,
                                    "reached when a bleeding has come to a stand");
  registry.add<TimerRupture>("timer_rupture", Kind::exercise_rule, "clock from the rupture to the final clip");
  registry.add<TimerTemporaryClip>("timer_temporary_clip", Kind::exercise_rule, "clock of a temporary clip");
  registry.add<GoalTemporaryRemoved>("goal_temporary_removed", Kind::exercise_rule,
                                     "reached when the temporary clip is off again");
}
