// SPDX-License-Identifier: GPL-3.0-or-later
/*
# hints

Hints for a trainee who practises, each a rule on a channel, on the limit of another rule, or on the band of a metric:

    share = 1 + (value - limit) / |limit|      above; below likewise with the other sign

A hint holds from the share `warning` on, so it comes before the limit is passed. `tutor` gives the cues: at most one in
its `pause`, the hint with the largest share. A cue is an event `hint` of the step in which its hint has held for
`hold`. The tutor only reads, and gives its cues in every session. Pages show them while somebody practises, and not in
a test.
*/
#include <algorithm>

#include "core/sim/tutor.h"
#include "plugins/hints/hint.h"
#include "plugins/hints/register.h"

namespace insula {
namespace {

/// Smaller shares are no cause worth telling.
constexpr double near_cue = 0.5;

class Tutor final : public ExerciseRule, public GivesCues {
 public:
  Param<Duration> pause{
      this, {.name = "pause", .fallback = "10 s", .min = "10 s", .max = "600 s", .doc = "least time between two cues"}};
  EventKind hint{this,
                 {.name = "hint",
                  .doc = "a cue for a trainee who practises; its id is that of the hint",
                  .value = "share of the way to the limit, 1 at the limit"}};
  Channel<Scalar> given{this,
                        {.name = "given", .doc = "cues until now", .min = "0", .shown = Shown::none, .digits = 0}};

  void declare(PrepareContext& context, const Simulation& simulation, ExerciseLog&) override {
    const auto tutors = simulation.exercise()->children_of<Tutor>();
    if (tutors.front() != this) error(context, "an exercise has one tutor; it has one already");
    hints_ = simulation.exercise()->children_of<Hint>();
    if (hints_.empty()) error(context, "has no hint to give: put hints into its exercise");
    now_.resize(hints_.size());
    choice_ = CueChoice(hints_.size(), pause());
    given.set(0);
  }
  void observe(const StepReport& report, ExerciseLog& log) override {
    for (std::size_t i = 0; i < hints_.size(); ++i) now_[i] = hints_[i]->look(report);
    if (log.state() != ExerciseState::running) return;
    const int chosen = choice_.choose(now_, report.time, report.h);
    if (chosen < 0) return;
    const Hint& of = *hints_[std::size_t(chosen)];
    cues_.push_back({cause(std::size_t(chosen)), report.time});
    cues_.back().cause.away = of.direction(report);
    given.set(double(cues_.size()));
    log.events.emit({hint.name(), of.id, of.text(), of.now().share, report.time, of.hand()});
  }
  void reset() override {
    choice_.reset();
    cues_.clear();
    std::fill(now_.begin(), now_.end(), HintNow{});
    given.set(0);
  }

  const std::vector<Cue>& cues() const override { return cues_; }
  std::vector<HintCause> causes() const override {
    std::vector<HintCause> out;
    for (std::size_t i = 0; i < hints_.size(); ++i)
      if (now_[i].share >= near_cue) out.push_back(cause(i));
    std::stable_sort(out.begin(), out.end(), [](const HintCause& a, const HintCause& b) { return a.share > b.share; });
    return out;
  }

 private:
  HintCause cause(std::size_t i) const {
    const Hint& h = *hints_[i];
    const HintReading& now = h.now();
    HintCause out;
    out.id = h.id;
    out.text = h.text();
    out.watched = h.watched();
    out.value = h.worded(now.value);
    out.limit = h.worded(now.limit);
    out.share = now.share;
    out.warning = h.warning();
    out.holds = choice_.holds(i);
    out.hand = h.hand();
    return out;
  }

  std::vector<Hint*> hints_;
  std::vector<HintNow> now_;
  CueChoice choice_{0, 0};
  std::vector<Cue> cues_;
};

}  // namespace

bool Hint::has_tutor() const {
  return std::any_of(parent->children.begin(), parent->children.end(),
                     [](const auto& c) { return dynamic_cast<const Tutor*>(c.get()) != nullptr; });
}

}  // namespace insula

INSULA_PLUGIN(hints) {
  using namespace insula;
  registry.add<Tutor>("tutor", Kind::exercise_rule, "gives the cues of the hints of its exercise, one at a time");
  register_limit_hints(registry);
  register_hint_metric(registry);
  register_hint_approach(registry);
}
