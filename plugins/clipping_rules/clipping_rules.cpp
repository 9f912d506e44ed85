// SPDX-License-Identifier: GPL-3.0-or-later
/*
# clipping_rules

Judges a clipped aneurysm. `goal_clipped` measures in every step

- the remnant as a Sindou grade (0 nothing left ... 5 more than three quarters of the sac),
- flow and narrowing of each branch, in percent of the values at rest,
- how far the blades' tips reach past the neck, the slit between the blades, and how often a clip was released.

The goal is reached when released clips have held the neck shut, with every branch open, for `hold`. It is lost again
when the clip is taken back, or when an instructor asks for another placement (`ask_again`). It must then be reached
with a new release.

`fault_stenosis` counts a branch whose flow falls below `limit` for longer than `grace` while no temporary clip is on.

Sources: Sindou, Acevedo, Turjman 1998 (grades); neck_judge.h describes the geometry.
*/
#include <algorithm>
#include <cmath>

#include "core/base/text.h"
#include "core/registry/registry.h"
#include "core/sim/exercise.h"
#include "core/sim/simulation.h"
#include "plugins/blood_flow/vessel_state.h"
#include "plugins/clipping_rules/neck_judge.h"

namespace insula {
namespace {

const VesselState* find(const std::vector<VesselState>& vessels, std::string_view id) {
  for (const VesselState& v : vessels)
    if (v.id == id) return &v;
  return nullptr;
}

double flow_percent(const VesselState& v) { return v.flow_at_rest != 0 ? 100 * v.flow / v.flow_at_rest : 100; }

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
                     (near.empty() ? "; it has " + joined(known) : "; did you mean " + in_quotes(near) + "?"));
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
                        .fallback = "0.05",
                        .min = "0",
                        .max = "1",
                        .doc = "narrowest cross-section of the sac over that at rest below which it counts as closed"}};
  Param<Duration> hold{
      this, {.name = "hold", .fallback = "3 s", .min = "0 s", .max = "600 s", .doc = "how long it must hold"}};

  void declare(PrepareContext& context, const Simulation& simulation, ExerciseLog& log) override {
    clips_ = Clips(simulation);
    vessels_ = Vessels(simulation);
    goal_ = log.add_goal(id, text());
    const auto* vessel = dynamic_cast<const ShellBody*>(&*on);
    if (!vessel || !judge_.attach(*vessel))
      return error(context, on, "needs a shell_body with a vessel that has a neck and a region \"sac\"");
    vessel_names(context, *this, sac, *vessel);
    branch_names_ = vessel_names(context, *this, branches, *vessel);
    remnant_ = log.add_measure(id + "_remnant", "Remnant (Sindou grade)", "", "at most " + std::to_string(max_grade()));
    neck_ = log.add_measure(id + "_neck", "Neck remnant", "%", "below 10 %");
    past_ = log.add_measure(id + "_tip", "Blade tip past the neck", "mm", "between 0 and 4 mm");
    slit_ = log.add_measure(id + "_slit", "Slit between the blades", "mm", "below 1.2 mm");
    count_ = log.add_measure(id + "_applications", "Clip applications", "", "at most 2");
    const std::string least_flow = "at least " + std::to_string(int(std::lround(100 * min_flow()))) + " %";
    for (const std::string& b : branch_names_) {
      flow_.push_back(log.add_measure(id + "_flow_" + b, "Flow of the " + b + " branch", "%", least_flow));
      narrow_.push_back(log.add_measure(id + "_stenosis_" + b, "Stenosis of the " + b + " branch", "%", "below 30 %"));
    }
    reset();
  }

  std::vector<CommandInfo> commands() const override {
    return {{"ask_again", "Ask for another placement of the clip", "", 0, 0}};
  }
  std::string run_command(std::string_view, std::string_view) override {
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
      log.goal_lost(goal_, r.time);
      log.message("Take the clip back and place it again", r.time);
    }
    const VesselState* s = find(vessels, sac());
    const bool shut = s && s->lumen < sealed();
    const NeckJudgement j = judge_.judge(clips, shut);
    bool open = true;
    for (std::size_t i = 0; i < branch_names_.size(); ++i) {
      const VesselState* b = find(vessels, branch_names_[i]);
      if (!b) continue;
      const double flow = flow_percent(*b), stenosis = 100 * (1 - std::min(1.0, b->lumen));
      log.measure(flow_[i], flow, flow >= 100 * min_flow() ? 1 : -1);
      log.measure(narrow_[i], stenosis, stenosis < 30 ? 1 : stenosis < 50 ? 0 : -1);
      open = open && flow >= 100 * min_flow();
    }
    log.measure(count_, applications, applications <= 2 ? 1 : applications <= 4 ? 0 : -1);
    if (j.clips > 0) {
      log.measure(remnant_, j.grade, j.grade <= max_grade() ? 1 : j.grade <= 2 ? 0 : -1);
      log.measure(neck_, 100 * j.neck_open, j.neck_open < 0.1 ? 1 : j.neck_open < 0.5 ? 0 : -1);
      log.measure(past_, 1000 * j.tip_past_neck, j.tip_past_neck > 0 && j.tip_past_neck < 0.004 ? 1 : -1);
      log.measure(slit_, 1000 * j.gap, j.gap < 0.0012 ? 1 : -1);
    }
    const bool good = j.clips > 0 && shut && j.grade <= max_grade() && open && applications >= min_applications_;
    held_ = good ? held_ + r.h : 0;
    if (good && held_ >= hold()) log.goal(goal_, r.time);
    if (!good && log.goals()[std::size_t(goal_)].done) log.goal_lost(goal_, r.time);
  }
  void reset() override {
    held_ = 0;
    asked_ = false;
    min_applications_ = 1;
  }

 private:
  Clips clips_;
  Vessels vessels_;
  NeckJudge judge_;
  std::vector<std::string> branch_names_;
  int goal_ = 0, remnant_ = 0, neck_ = 0, past_ = 0, slit_ = 0, count_ = 0;
  std::vector<int> flow_, narrow_;
  double held_ = 0;
  bool asked_ = false;
  int min_applications_ = 1;
};

class FaultStenosis final : public ExerciseRule {
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
    reset();
  }
  void observe(const StepReport& r, ExerciseLog& log) override {
    bool temporary = false;
    const std::vector<VesselState>& vessels = vessels_.now();
    for (const ClipState& c : clips_.now()) temporary = temporary || (c.temporary && !c.on_tray && !c.holder);
    for (std::size_t i = 0; i < names_.size(); ++i) {
      const VesselState* b = find(vessels, names_[i]);
      const bool low = b && !temporary && flow_percent(*b) < 100 * limit();
      below_[i] = low ? below_[i] + r.h : 0;
      if (low && below_[i] > grace() && armed_[i]) {
        armed_[i] = 0;
        log.fault(fault_, r.time, flow_percent(*b));
      }
      if (!low) armed_[i] = 1;
    }
  }
  void reset() override {
    below_.assign(names_.size(), 0.0);
    armed_.assign(names_.size(), 1);
  }

 private:
  Clips clips_;
  Vessels vessels_;
  int fault_ = 0;
  std::vector<std::string> names_;
  std::vector<double> below_;
  std::vector<char> armed_;
};

}  // namespace
}  // namespace insula

INSULA_PLUGIN(clipping_rules) {
  using namespace insula;
  registry.add<GoalClipped>("goal_clipped", Kind::exercise_rule,
                            "reached when clips hold the neck shut and the branches stay open");
  registry.add<FaultStenosis>("fault_stenosis", Kind::exercise_rule, "counts branches closed by a misplaced clip");
}
