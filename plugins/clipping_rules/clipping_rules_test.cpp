// SPDX-License-Identifier: GPL-3.0-or-later
// The judge of a clipping against blades put at known places, and the rules against reports made by hand.
#include <gtest/gtest.h>

#include <fstream>
#include <iterator>

#include "core/mechanics/shell_body.h"
#include "core/testing/example.h"
#include "plugins/blood_flow/vessel_state.h"
#include "plugins/clip/clip_state.h"
#include "plugins/clipping_rules/neck_judge.h"

namespace insula {
namespace {

const std::filesystem::path example = std::filesystem::path(INSULA_SOURCE_DIR) / "plugins/clipping_rules/example.xml";

/// Vessels that a test sets.
class FakeVessels final : public Constraint, public VesselSource {
 public:
  void build(const StepContext&, ConstraintBuilder&) override {}
  void append_vessels(std::vector<VesselState>& out) const override {
    out.insert(out.end(), vessels.begin(), vessels.end());
  }
  std::vector<VesselState> vessels;
};

/// A clip that a test sets; on the tray at first.
class FakeClip final : public Constraint, public ClipSource {
 public:
  void build(const StepContext&, ConstraintBuilder&) override {}
  ClipState clip_state() const override { return state; }
  ClipState state;
};

class ClippingRules : public ::testing::Test {
 protected:
  void SetUp() override {
    registry.add<FakeVessels>("fake_vessels", Kind::constraint, "for tests");
    registry.add<FakeClip>("fake_clip", Kind::constraint, "for tests");
    load("");
  }
  /// The example, with more parameters of its goal.
  void load(const std::string& more) {
    std::ifstream in(example);
    std::string text{std::istreambuf_iterator<char>(in), {}};
    const std::string goal = "<goal_clipped ";
    text.insert(text.find(goal) + goal.size(), more + " ");
    text.insert(text.find("<exercise"),
                "<fake_vessels id=\"network\"/><fake_clip id=\"fake\"/><fake_clip id=\"fake_temporary\"/>");
    auto loaded = load_simulation_text(text, example, registry, 1);
    ASSERT_TRUE(loaded.simulation) << loaded.diagnostics.format();
    s = std::move(loaded.simulation);
    ASSERT_TRUE(s->exercise());
    network = s->scene().find_as<FakeVessels>("network");
    in_field = &s->scene().find_as<FakeClip>("fake")->state;
    artery = s->scene().find_as<ShellBody>("artery");
    ASSERT_TRUE(artery);
    const WallModel& m = artery->model();
    up = m.neck_normal;
    centre = m.neck_centre;
    across = up.unitOrthogonal();
    report.h = 0.05;
    for (const char* id : {"parent", "superior", "inferior", "sac"}) {
      VesselState v;
      v.id = id;
      v.flow = v.flow_at_rest = 1e-6;
      network->vessels.push_back(v);
    }
  }
  /// A released clip whose blades cross the neck's axis at this height, `past` beyond the neck's far side.
  ClipState clip(double height, double past = 2e-3) const {
    ClipState c;
    c.on_tray = false;
    c.applications = 1;
    c.gap = 0.6e-3;
    c.blade_width = 1.3e-3;
    c.normal = up.cross(across);
    const double radius = 0.5 * artery->model().neck_diameter;
    c.blade_tip = centre + height * up + (radius + past) * across;
    c.blade_root = centre + height * up - (radius + 3e-3) * across;
    return c;
  }
  /// The wall as if the blades had drawn it together into their plane, up to this height above the neck plane.
  void pinch(double to) {
    const Vec3 x = up.cross(across);
    for (int i = 0; i < artery->nodes(); ++i) {
      auto p = artery->q().segment<3>(3 * i);
      const Vec3 d = p - centre;
      if (d.dot(up) > -1e-3 && d.dot(up) < to && d.norm() < 6e-3) p -= 0.95 * x.dot(d) * x;
    }
  }
  NeckJudgement judge(const ClipState& c, bool sealed = true) {
    NeckJudge j;
    EXPECT_TRUE(j.attach(*artery));
    return j.judge({c}, sealed);
  }
  void show(double seconds) {
    for (double t = 0; t < seconds - 1e-9; t += report.h) {
      report.time += report.h;
      s->exercise()->log().events.clear();
      s->exercise()->observe(report);
    }
  }
  const ExerciseLog& log() { return s->exercise()->log(); }
  double measure(const std::string& id) {
    for (const MeasureState& m : log().measures())
      if (m.id == id) return m.value;
    throw std::runtime_error("no measure " + id);
  }
  static Registry builtin() {
    Registry r;
    register_builtin(r);
    return r;
  }
  Registry registry = builtin();
  std::unique_ptr<Simulation> s;
  FakeVessels* network = nullptr;
  ClipState* in_field = nullptr;
  ShellBody* artery = nullptr;
  Vec3 up, centre, across;
  StepReport report;
};

TEST_F(ClippingRules, GradesOfSindou) {
  NeckJudge j;
  ASSERT_TRUE(j.attach(*artery));
  EXPECT_EQ(j.judge({}, false).grade, 5);
  EXPECT_EQ(j.judge({}, false).clips, 0);
  pinch(1.5e-3);
  EXPECT_EQ(judge(clip(0)).grade, 0) << "flush with the neck";
  EXPECT_EQ(judge(clip(0), false).grade, 5) << "blood still passes";
  // Blood passes tips that end within the neck, and fills the whole dome.
  const NeckJudgement half = judge(clip(0, -0.5 * artery->model().neck_diameter));
  EXPECT_EQ(half.grade, 5);
  EXPECT_EQ(half.neck_open, 1);
  pinch(6e-3);
  EXPECT_EQ(judge(clip(2.4e-3)).grade, 4);
  EXPECT_EQ(judge(clip(2.4e-3)).neck_open, 1);
  EXPECT_EQ(judge(clip(4.8e-3)).grade, 5);
}

TEST_F(ClippingRules, OpenBladesHoldNothing) {
  // The wall is not drawn together: it lies farther from the slit's middle than a closed wall.
  EXPECT_EQ(judge(clip(0)).grade, 5);
  EXPECT_GT(judge(clip(0)).sac_open, 0.9);
}

TEST_F(ClippingRules, ASecondClipClosesWhatTheFirstLeaves) {
  pinch(1.5e-3);
  const double radius = 0.5 * artery->model().neck_diameter;
  ClipState near = clip(0, -radius), far = clip(0);
  far.blade_root = centre - 0.2 * radius * across;
  NeckJudge j;
  ASSERT_TRUE(j.attach(*artery));
  EXPECT_EQ(j.judge({near}, true).grade, 5);
  EXPECT_EQ(j.judge({far}, true).grade, 5);
  const NeckJudgement both = j.judge({near, far}, true);
  EXPECT_EQ(both.clips, 2);
  EXPECT_EQ(both.grade, 0);
  EXPECT_EQ(both.needed, 2) << "each closes its part";
  // A clip over the whole neck makes those of both halves idle, and is itself idle beside both.
  EXPECT_EQ(j.judge({clip(0)}, true).needed, 1);
  EXPECT_EQ(j.judge({clip(0), near}, true).needed, 1);
  EXPECT_EQ(j.judge({clip(0), clip(0)}, true).needed, 0) << "either of them would do";
  EXPECT_EQ(j.judge({clip(0), near, far}, true).needed, 0);
}

TEST_F(ClippingRules, ANeckForTwoClipsIsNotDoneWithOne) {
  load("clips=\"2\"");
  pinch(1.5e-3);
  const double radius = 0.5 * artery->model().neck_diameter;
  FakeClip* second = s->scene().find_as<FakeClip>("fake_temporary");
  network->vessels[3].lumen = 0;
  *in_field = clip(0);
  show(2);
  EXPECT_FALSE(log().goals()[0].done);
  EXPECT_EQ(log().last_message(), "The neck is to be shared by 2 clips: 1 of those on it closes what no other does.");
  second->state = clip(0);
  show(2);
  EXPECT_FALSE(log().goals()[0].done) << "two that hold the same folds";
  *in_field = clip(0, -radius);
  second->state.blade_root = centre - 0.2 * radius * across;
  show(1);
  EXPECT_TRUE(log().goals()[0].done);
}

TEST_F(ClippingRules, MoreOfTheSacIsLeftTheHigherTheClip) {
  pinch(9e-3);
  double last = -1;
  for (double h = 0; h < 4e-3; h += 0.5e-3) {
    const double open = judge(clip(h)).sac_open;
    EXPECT_GE(open, last);
    last = open;
  }
  EXPECT_GT(last, 0.5);
}

TEST_F(ClippingRules, TipAndSlitAreMeasured) {
  const NeckJudgement a = judge(clip(0, 1e-3)), b = judge(clip(0, 3e-3));
  EXPECT_NEAR(b.tip_past_neck - a.tip_past_neck, 2e-3, 1e-12);
  EXPECT_NEAR(a.gap, 0.6e-3, 1e-15);
  ClipState far = clip(0);
  far.blade_root += 0.02 * up;
  far.blade_tip += 0.02 * up;
  EXPECT_EQ(judge(far).clips, 0) << "a clip elsewhere is not on the neck";
}

TEST_F(ClippingRules, GoalNeedsASealedNeckAndOpenBranches) {
  pinch(1.5e-3);
  *in_field = clip(0);
  show(1);
  EXPECT_FALSE(log().goals()[0].done) << "the sac still fills";
  network->vessels[3].lumen = 0;
  network->vessels[1].flow = 0.5e-6;
  show(1);
  EXPECT_FALSE(log().goals()[0].done) << "a branch is narrowed";
  EXPECT_NEAR(measure("superior.flow_pct"), 50, 1e-12);
  network->vessels[1].flow = 0.9e-6;
  show(0.4);
  EXPECT_FALSE(log().goals()[0].done) << "not long enough";
  show(0.2);
  EXPECT_TRUE(log().goals()[0].done);
  EXPECT_EQ(measure("grade"), 0);
  EXPECT_LT(measure("remnant_pct"), 10);
}

TEST_F(ClippingRules, AnotherPlacementCanBeAskedFor) {
  pinch(1.5e-3);
  EXPECT_TRUE(s->command("ask", "clip ask_again").empty());
  *in_field = clip(0);
  network->vessels[3].lumen = 0;
  show(2);
  EXPECT_FALSE(log().goals()[0].done) << "the same placement does not count again";
  in_field->applications = 2;
  show(1);
  EXPECT_TRUE(log().goals()[0].done);
}

TEST_F(ClippingRules, WhatIsMissingIsSaidOnce) {
  pinch(6e-3);
  *in_field = clip(2.4e-3);
  network->vessels[3].lumen = 0;
  network->vessels[2].flow = 0.7e-6;
  show(0.9);
  EXPECT_EQ(log().last_message(), "") << "it may still settle";
  show(0.5);
  EXPECT_EQ(log().last_message(),
            "A remnant stands above 100 % of the neck (grade 4). The inferior branch flows at 70 %.");
  network->vessels[2].flow = 1e-6;
  network->vessels[3].lumen = 0.3;
  show(1.5);
  EXPECT_EQ(log().last_message(), "Blood still enters the aneurysm.");
}

TEST_F(ClippingRules, ATemporaryClipIsSaidToComeOffOnceTheNeckIsShut) {
  // The example's clip is the neck's, the other one that of the parent artery.
  FakeClip* parent = s->scene().find_as<FakeClip>("fake_temporary");
  ASSERT_TRUE(parent);
  parent->state = clip(0);
  parent->state.temporary = true;
  pinch(1.5e-3);
  *in_field = clip(0);
  network->vessels[3].lumen = 0;
  network->vessels[2].flow = 0;
  show(1.5);
  EXPECT_EQ(log().last_message(), "The neck is shut: take the temporary clip off.");
  EXPECT_FALSE(log().goals()[0].done);
  parent->state.on_tray = true;
  show(1.5);
  EXPECT_EQ(log().last_message(), "The inferior branch flows at 0 %.") << "now the clip on the neck is what stops it";
}

TEST_F(ClippingRules, AClipThatMovesOnTheNeckHasSlipped) {
  const auto slips = [&] { return log().faults()[1].count; };
  *in_field = clip(0);
  in_field->force = 1.8;
  show(0.3);
  in_field->blade_root += 2e-3 * up;
  in_field->blade_tip += 2e-3 * up;
  show(0.5);
  EXPECT_EQ(slips(), 0) << "the applier has only just let go";
  for (int i = 0; i < artery->nodes(); ++i) artery->q().segment<3>(3 * i) += 3e-3 * up;
  in_field->blade_root += 3e-3 * up;
  in_field->blade_tip += 3e-3 * up;
  show(0.5);
  EXPECT_EQ(slips(), 0) << "the clip moves with the whole vessel";
  in_field->blade_root += 1.6e-3 * across;
  in_field->blade_tip += 1.6e-3 * across;
  show(0.5);
  EXPECT_EQ(slips(), 1);
  show(2);
  EXPECT_EQ(slips(), 1) << "one fault for each time it shuts";
  in_field->gap = 5e-3;
  show(0.2);
  in_field->gap = 0.6e-3;
  show(1);
  in_field->blade_tip += 4e-3 * across;
  show(0.2);
  EXPECT_EQ(slips(), 2);
}

// An instructor asks after the end: the exercise goes on, and a new placement ends it again.
TEST_F(ClippingRules, AnotherPlacementCanBeAskedForAfterTheEnd) {
  pinch(1.5e-3);
  *in_field = clip(0);
  network->vessels[3].lumen = 0;
  show(2);
  ASSERT_EQ(log().state(), ExerciseState::done);
  EXPECT_TRUE(s->command("ask", "clip ask_again").empty());
  show(2);
  EXPECT_EQ(log().state(), ExerciseState::running);
  EXPECT_FALSE(log().goals()[0].done) << "the same placement does not count again";
  in_field->on_tray = true;
  show(0.2);
  EXPECT_EQ(measure("grade"), 5) << "a clip that was taken back leaves the whole sac";
  in_field->on_tray = false;
  in_field->applications = 2;
  show(1);
  EXPECT_EQ(log().state(), ExerciseState::done);
}

TEST_F(ClippingRules, NobodyIsToldOfANegativeFlow) {
  network->vessels[1].flow = -0.016e-6;
  show(0.1);
  EXPECT_EQ(measure("superior.flow_pct"), 0);
  for (const MeasureState& m : log().measures())
    if (m.id == "superior.flow_pct") {
      EXPECT_EQ(m.good, -1);
      EXPECT_NEAR(m.band[0].value(), 75, 1e-9) << "from min_flow";
    }
}

TEST_F(ClippingRules, AClosedBranchIsOneFault) {
  network->vessels[2].flow = 0.2e-6;
  show(0.4);
  EXPECT_EQ(log().faults()[0].count, 0);
  show(2);
  EXPECT_EQ(log().faults()[0].count, 1);
  for (int beat = 0; beat < 5; ++beat) {
    network->vessels[2].flow = 0.6e-6;
    show(0.2);
    network->vessels[2].flow = 0.2e-6;
    show(2);
  }
  EXPECT_EQ(log().faults()[0].count, 1) << "its flow rose above the limit for moments only";
  ClipState temporary = clip(0);
  temporary.temporary = true;
  network->vessels[2].flow = 1e-6;
  show(0.1);
  *in_field = temporary;
  network->vessels[2].flow = 0;
  show(2);
  EXPECT_EQ(log().faults()[0].count, 1) << "a temporary clip is meant to";
  network->vessels[2].flow = 1e-6;
  show(2);
  in_field->holder = artery;
  in_field->force = 0.8;
  network->vessels[2].flow = 0;
  show(2);
  EXPECT_EQ(log().faults()[0].count, 1) << "so is one that the applier has not let go";
  in_field->on_tray = true;
  network->vessels[2].flow = 1e-6;
  show(2);
  network->vessels[2].flow = 0;
  show(2);
  EXPECT_EQ(log().faults()[0].count, 2) << "it had flowed again";
}

}  // namespace
}  // namespace insula
