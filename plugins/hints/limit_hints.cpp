// SPDX-License-Identifier: GPL-3.0-or-later
// Hints on channels: one with a limit of its own, and one that takes channels and limit from the rule that it guards.
#include <algorithm>

#include "core/base/text.h"
#include "core/sim/watched_limit.h"
#include "plugins/exercise_rules/channel_rules.h"
#include "plugins/hints/foresight.h"
#include "plugins/hints/hint.h"
#include "plugins/hints/register.h"

namespace insula {
namespace {

class LimitHint : public Hint {
 public:
  Param<Duration> ahead{this,
                        {.name = "ahead",
                         .fallback = "0 s",
                         .min = "0 s",
                         .max = "2 s",
                         .doc = "for how long the value is carried on at its present rate, for what rises fast"}};

  void reset() override {
    Hint::reset();
    foresight_.clear();
  }

 protected:
  /// Share of the limit, now or as foreseen, whichever is worse.
  double share(const StepReport& report, std::size_t which, double value, double limit, bool above) {
    if (which >= foresight_.size()) foresight_.resize(which + 1);
    const double later = foresight_[which].carried_on(value, ahead(), report.h);
    return std::max(share_of_limit(value, limit, above), share_of_limit(later, limit, above));
  }

 private:
  std::vector<Foresight> foresight_;
};

class HintChannel final : public LimitHint {
 public:
  Param<std::string> channel{this, {.name = "channel", .doc = "component and channel: \"arachnoid.tension\""}};
  Param<Choice> comparison{this,
                           {.name = "comparison",
                            .fallback = "above",
                            .choices = {"above", "below"},
                            .doc = "on which side of the limit it is bad"}};
  Param<std::string> limit{this, {.name = "limit", .doc = "limit with a unit of the channel, not zero: \"40 mN\""}};

  std::string watched() const override { return channel(); }
  std::string worded(double value) const override {
    return watch_.entry() ? watch_.entry()->channel->text(value) : std::string();
  }

 protected:
  void find(PrepareContext& context, const Simulation& simulation) override {
    if (watch_.connect(context, simulation, *this, channel, limit) && watch_.limit() == 0)
      error(context, limit, "must not be zero: how near a hint is to its limit is a share of the limit");
  }
  HintReading read(const StepReport& report) override {
    HintReading out;
    out.value = watch_.value(report);
    out.limit = watch_.limit();
    out.share = share(report, 0, out.value, out.limit, comparison.is("above"));
    return out;
  }

 private:
  ChannelWatch watch_;
};

class HintRule final : public LimitHint {
 public:
  Param<std::string> rule{this, {.name = "rule", .doc = "id of the rule of the exercise that it guards"}};

  std::string watched() const override {
    if (limits_.empty()) return {};
    const WatchedLimit& of = limits_[now().which];
    return of.owner->id + "." + of.channel->name(of.item);
  }
  std::string worded(double value) const override {
    return limits_.empty() ? std::string() : limits_[now().which].channel->text(value);
  }

 protected:
  void find(PrepareContext& context, const Simulation& simulation) override {
    std::vector<std::string> known;
    guarded_ = nullptr;
    for (const ExerciseRule* r : simulation.exercise()->children_of<ExerciseRule>()) {
      const auto* watches = dynamic_cast<const WatchesLimits*>(r);
      if (!watches) continue;
      known.push_back(r->id);
      if (r->id == rule()) guarded_ = watches;
    }
    if (guarded_) return;
    const std::string near = nearest_name(rule(), known);
    error(context, rule,
          "the exercise has no rule " + in_quotes(rule()) + " with a limit" +
              (!near.empty()   ? did_you_mean(near)
               : known.empty() ? ""
                               : " (it has " + joined(known) + ")"));
  }
  HintReading read(const StepReport& report) override {
    if (limits_.empty()) limits_ = guarded_->watched_limits();
    HintReading worst;
    if (!guarded_->watches_now()) return worst;
    for (std::size_t i = 0; i < limits_.size(); ++i) {
      const WatchedLimit& l = limits_[i];
      const double value = *l.channel->values(l.item), near = share(report, i, value, l.limit, l.above);
      if (std::isnan(near) || near <= worst.share) continue;
      worst = {near, value, l.limit, l.hand, i, Vec3::Zero()};
    }
    return worst;
  }

 private:
  const WatchesLimits* guarded_ = nullptr;
  std::vector<WatchedLimit> limits_;
};

}  // namespace

void register_limit_hints(Registry& registry) {
  registry.add<HintChannel>("hint_channel", Kind::exercise_rule, "a hint when a channel comes near a limit");
  registry.add<HintRule>("hint_rule", Kind::exercise_rule, "a hint before a rule of the exercise is broken");
}

}  // namespace insula
