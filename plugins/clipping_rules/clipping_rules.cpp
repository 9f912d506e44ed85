// SPDX-License-Identifier: GPL-3.0-or-later
/*
# clipping_rules

Judges a clipped aneurysm. `goal_clipped` measures in every step

- the remnant as a Sindou grade (`grade`: 0 nothing left ... 5 more than three quarters of the sac), and the share of
the neck above which it stands (`remnant_pct`),
- flow and narrowing of each branch, in percent of the values at rest (`superior_flow_pct`, `superior_stenosis_pct`),
- how far the blades' tips reach past the neck, the slit between the blades, and how often a clip was released.

The goal is reached when released clips have held the neck shut, with every branch open, for `hold`. It is lost again
when the clip is taken back, or when an instructor asks for another placement (`ask_again`). It must then be reached
with a new release. While a released clip lies on the neck and the goal is not reached, a message says what is missing.

With `clips="2"` two clips must share the neck: each closes a part that the other leaves open (`clips_needed`).

`fault_slipped` counts shut blades that move on the vessel by more than `limit`, because they hold too little of it or
because the applier pulls at them. Motion of the whole neck, by pulse and by other tools, does not count.

While the heart pauses (`adenosine_pause`) no flow is judged. A goal is neither reached nor lost by it.

`fault_stenosis` counts a branch whose flow falls below `limit` for longer than `grace` while no temporary clip is on,
neither released nor shut in an applier. It counts the branch again once it has flowed for as long. Hints on it wait for
two seconds after a temporary clip, since flow is the mean of a heartbeat and is still low then.

Sources: Sindou, Acevedo, Turjman 1998 (grades); neck_judge.h describes the geometry.
*/
#include <fmt/format.h>

#include <algorithm>
#include <limits>

#include "core/base/spoken.h"
#include "core/base/text.h"
#include "core/registry/registry.h"
#include "core/sim/exercise.h"
#include "core/sim/simulation.h"
#include "core/sim/watched_limit.h"
#include "plugins/blood_flow/vessel_state.h"
#include "plugins/clipping_rules/neck_judge.h"

namespace insula {
namespace {

const VesselState* find(const std::vector<VesselState>& vessels, std::string_view id) {
  for (const VesselState& v : vessels)
    if (v.id == id) return &v;
  return nullptr;
}

/// Flow over that at rest, as a claim to a person: flow back through a closed branch counts as none.
double flow_share(const VesselState& v) { return v.flow_at_rest != 0 ? std::max(0.0, v.flow / v.flow_at_rest) : 1; }

bool heart_rests(const std::vector<VesselState>& vessels) {
  return std::any_of(vessels.begin(), vessels.end(), [](const VesselState& v) { return v.heart_rests; });
}

bool temporary_on(const std::vector<ClipState>& clips) {
  return std::any_of(clips.begin(), clips.end(), [](const ClipState& c) { return c.temporary && c.is_on(); });
}

/// The names in `text`, each checked to be a centreline of the vessel.
std::vector<std::string> vessel_names(PrepareContext& context, const Component& rule, const Param<std::string>& param,
                                      const ShellBody& vessel) {
  std::vector<std::string> known, out;
  for (const auto& c : vessel.model().centrelines) known.push_back(c.name);
  for (std::string_view word : split_blanks(param())) {
    const std::string name(word);
    if (std::find(known.begin(), known.end(), name) == known.end()) {
      const std::string near = nearest_name(name, known);
      rule.error(context, param,
                 in_quotes(name) + " is no centreline of \"" + vessel.id + "\"" +
                     (near.empty() ? "; it has " + joined(known) : did_you_mean(near)));
    }
    out.push_back(name);
  }
  return out;
}

class GoalClipped final : public ExerciseRule {
 public:
  Param<std::string> text{
      this,
      {.name = "text", .fallback = "Close the neck of the aneurysm with a clip", .doc = "what the trainee is to do"}};
  Ref<Body> on{this, {.name = "on", .doc = "the artery, a shell_body made from a vessel"}};
  Param<std::string> sac{this, {.name = "sac", .fallback = "sac", .doc = "centreline of the sac"}};
  Param<std::string> branches{
      this, {.name = "branches", .fallback = "superior inferior", .doc = "centrelines that must stay open"}};
  Param<int> max_grade{
      this,
      {.name = "max_grade", .fallback = "1", .min = "0", .max = "5", .doc = "worst Sindou grade that is accepted"}};
  Param<Scalar> min_flow{this,
                         {.name = "min_flow",
                          .fallback = "0.75",
                          .min = "0",
                          .max = "1",
                          .doc = "least flow of a branch over its flow at rest"}};
  Param<Scalar> sealed{this,
                       {.name = "sealed",
                        .fallback = "0.02",
                        .min = "0",
                        .max = "1",
                        .doc = "narrowest cross-section of the sac over that at rest below which it counts as closed"}};
  Param<Duration> hold{
      this, {.name = "hold", .fallback = "3 s", .min = "0 s", .max = "600 s", .doc = "how long it must hold"}};
  Param<int> least_clips{this,
                         {.name = "clips",
                          .fallback = "1",
                          .min = "1",
                          .max = "4",
                          .doc = "least number of clips that share the neck: without each of them more would be open"}};

  Channel<Scalar> grade{this,
                        {.name = "grade",
                         .doc = "Remnant (Sindou grade)",
                         .min = "0",
                         .max = "5",
                         .shown = Shown::none,
                         .digits = 0,
                         .high = {.to = "2"},
                         .measure = true}};
  Channel<Scalar> remnant{this,
                          {.name = "remnant",
                           .doc = "Neck remnant",
                           .min = "0",
                           .max = "1",
                           .shown = Shown::none,
                           .display = "%",
                           .digits = 0,
                           .good = {.to = "0.1"},
                           .high = {.to = "0.5"},
                           .measure = true}};
  Channel<Length> tip_past_neck{this,
                                {.name = "tip_past_neck",
                                 .doc = "Blade tip past the neck",
                                 .shown = Shown::none,
                                 .display = "mm",
                                 .digits = 1,
                                 .good = {.from = "0 mm", .to = "4 mm"},
                                 .measure = true}};
  Channel<Length> slit{this,
                       {.name = "slit",
                        .doc = "Slit between the blades",
                        .min = "0 mm",
                        .shown = Shown::none,
                        .display = "mm",
                        .digits = 1,
                        .good = {.to = "1.2 mm"},
                        .measure = true}};
  Channel<Scalar> applications_now{this,
                                   {.name = "applications",
                                    .doc = "Clip applications",
                                    .min = "0",
                                    .shown = Shown::none,
                                    .digits = 0,
                                    .good = {.to = "2"},
                                    .high = {.to = "4"},
                                    .measure = true}};
  Channel<Scalar> clips_needed{this,
                               {.name = "clips_needed",
                                .doc = "Clips that each close a part of the neck",
                                .min = "0",
                                .shown = Shown::none,
                                .digits = 0}};
  ChannelGroup<Scalar> flow{this,
                            {.name = "flow",
                             .doc = "Flow over that at rest",
                             .min = "0",
                             .shown = Shown::none,
                             .display = "%",
                             .digits = 0,
                             .measure = true}};
  ChannelGroup<Scalar> stenosis{this,
                                {.name = "stenosis",
                                 .doc = "Stenosis",
                                 .min = "0",
                                 .max = "1",
                                 .shown = Shown::none,
                                 .display = "%",
                                 .digits = 0,
                                 .good = {.to = "0.3"},
                                 .high = {.to = "0.5"},
                                 .measure = true}};

  void prepare(PrepareContext&) override {
    std::vector<std::string> names;
    for (std::string_view word : split_blanks(branches())) names.emplace_back(word);
    flow.declare(names);
    stenosis.declare(std::move(names));
    grade.set_bands({std::nullopt, double(max_grade())}, grade.high());
    flow.set_bands({min_flow(), std::nullopt});
  }
  void declare(PrepareContext& context, const Simulation& simulation, ExerciseLog& log) override {
    clips_ = Clips(simulation);
    vessels_ = Vessels(simulation);
    goal_ = log.add_goal(id, text());
    const auto* vessel = dynamic_cast<const ShellBody*>(&*on);
    if (!vessel || !judge_.attach(*vessel))
      return error(context, on, "needs a shell_body with a vessel that has a neck and a region \"sac\"");
    vessel_names(context, *this, sac, *vessel);
    branch_names_ = vessel_names(context, *this, branches, *vessel);
    reset();
  }

  std::vector<CommandInfo> commands() const override {
    return {{"ask_again", "Ask for another placement of the clip", "", 0, 0}};
  }
  std::string run_command(std::string_view, std::string_view) override {
    if (failed_) return "the exercise has failed; reset it first";
    asked_ = true;
    return {};
  }

  void observe(const StepReport& r, ExerciseLog& log) override {
    int applications = 0;
    const std::vector<ClipState>& clips = clips_.now();
    const std::vector<VesselState>& vessels = vessels_.now();
    for (const ClipState& c : clips)
      if (!c.temporary) applications += c.applications;
    if (asked_) {
      asked_ = false;
      min_applications_ = applications + 1;
      log.reopen(r.time);
      log.goal_lost(goal_, r.time);
      log.message("Take the clip back and place it again", r.time);
    }
    const VesselState* s = find(vessels, sac());
    const bool shut = s && s->lumen < sealed();
    const NeckJudgement j = judge_.judge(clips, shut);
    const bool shared = least_clips() <= 1 || j.needed >= least_clips();
    Missing missing;
    missing.shut = !shut;
    missing.remnant = shut && j.grade > max_grade();
    missing.clips = shut && !missing.remnant && !shared;
    bool open = true;
    for (std::size_t i = 0; i < branch_names_.size(); ++i) {
      const VesselState* b = find(vessels, branch_names_[i]);
      if (!b) continue;
      flow.set(i, flow_share(*b));
      stenosis.set(i, 1 - std::clamp(b->lumen, 0.0, 1.0));
      if (flow(i) < min_flow() && missing.branch < 0) missing.branch = int(i), missing.flow = 100 * flow(i);
      open = open && flow(i) >= min_flow();
    }
    applications_now.set(applications);
    if (applications > 0 || j.clips > 0) show(j);
    const bool good =
        j.clips > 0 && shut && j.grade <= max_grade() && shared && open && applications >= min_applications_;
    held_ = good ? held_ + r.h : 0;
    if (good && held_ >= hold()) log.goal(goal_, r.time);
    const bool resting = shut && heart_rests(vessels);
    if (!good && !resting && log.goals()[std::size_t(goal_)].done) log.goal_lost(goal_, r.time);
    missing.temporary =
        !missing.shut && !missing.remnant && !missing.clips && missing.branch >= 0 && temporary_on(clips);
    if (j.clips == 0 || good || resting) missing = {};
    say(missing, j, r, log);
    failed_ = log.state() == ExerciseState::failed;
  }
  void reset() override {
    held_ = 0;
    asked_ = failed_ = false;
    min_applications_ = 1;
    said_ = {};
    unchanged_ = 0;
  }

 private:
  /// What keeps a clip on the neck from reaching the goal.
  struct Missing {
    bool shut = false, remnant = false, clips = false;
    int branch = -1;  ///< the first branch with too little flow
    double flow = 0;  ///< of that, %
    /// Nothing else is missing, and a temporary clip is on: nobody can tell yet whether the branch will flow.
    bool temporary = false;
    bool any() const { return shut || remnant || clips || branch >= 0; }
    bool same(const Missing& o) const {
      return shut == o.shut && remnant == o.remnant && clips == o.clips && branch == o.branch &&
             temporary == o.temporary;
    }
  };

  /// Says once what is missing, when that has not changed for a second.
  void say(const Missing& missing, const NeckJudgement& j, const StepReport& r, ExerciseLog& log) {
    constexpr double steady_s = 1;
    unchanged_ = missing.same(seen_) ? unchanged_ + r.h : 0;
    seen_ = missing;
    if (unchanged_ < steady_s || missing.same(said_)) return;
    said_ = missing;
    if (!missing.any()) return;
    std::string what;
    if (missing.shut && j.tip_past_neck < 0)
      what = fmt::format("Blood still enters the aneurysm: the tips end {:.1f} mm before the far side of the neck.",
                         -1000 * j.tip_past_neck);
    else if (missing.shut) what = "Blood still enters the aneurysm.";
    else if (missing.remnant)
      what = fmt::format("A remnant stands above {:.0f} % of the neck (grade {}).", 100 * j.neck_open, j.grade);
    else if (missing.clips)
      what = fmt::format("The neck is to be shared by {} clips: {} of those on it closes what no other does.",
                         least_clips(), j.needed);
    if (missing.temporary) what = "The neck is shut: take the temporary clip off.";
    else if (missing.branch >= 0)
      what += fmt::format("{}The {} branch flows at {:.0f} %.", what.empty() ? "" : " ",
                          spoken(branch_names_[std::size_t(missing.branch)]), missing.flow);
    log.message(what, r.time);
  }

  void show(const NeckJudgement& j) {
    const double unknown = std::numeric_limits<double>::quiet_NaN();
    grade.set(j.grade);
    remnant.set(j.neck_open);
    tip_past_neck.set(j.clips > 0 ? j.tip_past_neck : unknown);
    slit.set(j.clips > 0 ? j.gap : unknown);
    clips_needed.set(j.needed);
  }

  Clips clips_;
  Vessels vessels_;
  NeckJudge judge_;
  std::vector<std::string> branch_names_;
  int goal_ = 0;
  Missing seen_, said_;
  double unchanged_ = 0;  ///< time for which the same has been missing, s
  double held_ = 0;
  bool asked_ = false, failed_ = false;
  int min_applications_ = 1;
};

class FaultStenosis final : public ExerciseRule, public WatchesLimits {
 public:
  Param<std::string> text{
      this, {.name = "text", .fallback = "A branch is closed by the clip", .doc = "what the trainee is told"}};
  Ref<Body> on{this, {.name = "on", .doc = "the artery, a shell_body made from a vessel"}};
  Param<std::string> branches{
      this, {.name = "branches", .fallback = "superior inferior", .doc = "centrelines that must stay open"}};
  Param<Scalar> limit{this,
                      {.name = "limit",
                       .fallback = "0.5",
                       .min = "0",
                       .max = "1",
                       .doc = "least flow of a branch over its flow at rest"}};
  Param<Duration> grace{
      this, {.name = "grace", .fallback = "5 s", .min = "0 s", .max = "600 s", .doc = "shorter times are forgiven"}};

  void declare(PrepareContext& context, const Simulation& simulation, ExerciseLog& log) override {
    clips_ = Clips(simulation);
    vessels_ = Vessels(simulation);
    fault_ = log.add_fault(id, text());
    const auto* vessel = dynamic_cast<const ShellBody*>(&*on);
    if (!vessel) return error(context, on, "needs a shell_body with a vessel");
    names_ = vessel_names(context, *this, branches, *vessel);
    for (const ChannelEntry& e : simulation.channels().entries())
      if (e.channel->spec().name == "flow_share" &&
          std::find(names_.begin(), names_.end(), e.group()) != names_.end() && limit() > 0)
        flows_.push_back({e.channel, e.item, e.component, limit(), false, -1});
    reset();
  }
  std::vector<WatchedLimit> watched_limits() const override { return flows_; }
  bool watches_now() const override { return since_temporary_ >= flow_known_s; }
  void observe(const StepReport& r, ExerciseLog& log) override {
    const std::vector<VesselState>& vessels = vessels_.now();
    const bool temporary = temporary_on(clips_.now()) || heart_rests(vessels);
    since_temporary_ = temporary ? 0 : since_temporary_ + r.h;
    for (std::size_t i = 0; i < names_.size(); ++i) {
      const VesselState* b = find(vessels, names_[i]);
      const bool low = b && !temporary && flow_share(*b) < limit();
      below_[i] = low ? below_[i] + r.h : 0;
      above_[i] = low ? 0 : above_[i] + r.h;
      if (below_[i] > grace() && armed_[i]) {
        armed_[i] = 0;
        log.fault(fault_, r.time, 100 * flow_share(*b));
      }
      if (above_[i] > grace()) armed_[i] = 1;  // flow about the limit is one fault, and not one a beat
    }
  }
  void reset() override {
    below_.assign(names_.size(), 0.0);
    above_.assign(names_.size(), 0.0);
    armed_.assign(names_.size(), 1);
    since_temporary_ = flow_known_s;
  }

 private:
  /// Flow is the mean of the last heartbeat. For so long after a temporary clip it is still that below the clip, s.
  static constexpr double flow_known_s = 2;
  Clips clips_;
  Vessels vessels_;
  int fault_ = 0;
  std::vector<std::string> names_;
  std::vector<WatchedLimit> flows_;        ///< of the branches
  double since_temporary_ = flow_known_s;  ///< since no temporary clip has been on, s
  std::vector<double> below_, above_;      ///< for how long flow has been below the limit, and not, s
  std::vector<char> armed_;
};

class FaultSlipped final : public ExerciseRule {
 public:
  Param<std::string> text{
      this, {.name = "text", .fallback = "A shut clip has slipped on the vessel", .doc = "what the trainee is told"}};
  Ref<Body> on{this, {.name = "on", .doc = "the artery, a shell_body made from a vessel"}};
  Param<Length> limit{this,
                      {.name = "limit",
                       .fallback = "1.5 mm",
                       .min = "0.1 mm",
                       .max = "50 mm",
                       .doc = "motion of the blades' middle relative to the neck that is not yet slipping"}};
  Param<Duration> grace{this,
                        {.name = "grace",
                         .fallback = "0.5 s",
                         .min = "0 s",
                         .max = "60 s",
                         .doc = "from the closing of the blades, and from the release, to the position that counts"}};

  void declare(PrepareContext& context, const Simulation& simulation, ExerciseLog& log) override {
    clips_ = Clips(simulation);
    fault_ = log.add_fault(id, text());
    const auto* vessel = dynamic_cast<const ShellBody*>(&*on);
    if (!vessel || !judge_.attach(*vessel))
      return error(context, on, "needs a shell_body with a vessel that has a neck and a region \"sac\"");
    shut_.resize(clips_.now().size());
    reset();
  }
  void observe(const StepReport& r, ExerciseLog& log) override {
    constexpr double open_slit = 1.2e-3, holding = 0.05;  // m, N
    const std::vector<ClipState>& clips = clips_.now();
    const Vec3 neck = judge_.neck();
    for (std::size_t i = 0; i < clips.size(); ++i) {
      const ClipState& c = clips[i];
      Shut& at = shut_[i];
      if (c.on_tray || c.gap > open_slit || (c.force < holding && at.since < grace())) {
        at = {};
        continue;
      }
      const Vec3 middle = 0.5 * (c.blade_root + c.blade_tip) - neck;
      if (bool(c.holder) != at.held) at = {.held = bool(c.holder), .slipped = at.slipped};
      if (at.since < grace()) {
        at.since += r.h;
        at.middle = middle;
      } else if (!at.slipped && (middle - at.middle).norm() > limit()) {
        at.slipped = true;
        log.fault(fault_, r.time, 1000 * (middle - at.middle).norm());
      }
    }
  }
  void reset() override { std::fill(shut_.begin(), shut_.end(), Shut{}); }

 private:
  /// A clip whose blades hold something.
  struct Shut {
    double since = 0;            ///< s
    Vec3 middle = Vec3::Zero();  ///< of the blades from the neck's middle, m
    bool held = false;           ///< by an applier
    bool slipped = false;
  };
  Clips clips_;
  NeckJudge judge_;
  std::vector<Shut> shut_;
  int fault_ = 0;
};

}  // namespace
}  // namespace insula

INSULA_PLUGIN(clipping_rules) {
  using namespace insula;
  registry.add<GoalClipped>("goal_clipped", Kind::exercise_rule,
                            "reached when clips hold the neck shut and the branches stay open");
  registry.add<FaultSlipped>("fault_slipped", Kind::exercise_rule, "counts shut clips that slip on the vessel");
  registry.add<FaultStenosis>("fault_stenosis", Kind::exercise_rule, "counts branches closed by a misplaced clip");
}
