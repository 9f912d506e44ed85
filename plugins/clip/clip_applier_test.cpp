// SPDX-License-Identifier: GPL-3.0-or-later
// The applier: opening, letting go, taking back, loading, what the hand feels of it.
#include "core/testing/held.h"
#include "plugins/clip/clip_for_test.h"
#include "tests/figures/figure.h"

namespace insula {
namespace {

using test::ClipBench;
using test::closing;
using test::slope;
using test::widest;

const Pose grip_home{Vec3(0, 0, 14e-3), Quat::Identity()};

bool said(const Simulation& s, const std::string& kind, const std::string& id) {
  for (const Event& e : s.events())
    if (e.kind == kind && e.id == id) return true;
  return false;
}

struct Loaded : ClipBench {
  explicit Loaded(const std::string& before = "", const std::string& after = "", const std::string& scene = "") {
    load(before + clip_element("") + applier_element(R"(load="clip" open_time="0.2 s")") + after, scene);
  }
};

TEST(ClipApplier, ItsClipFollowsTheHand) {
  Loaded b;
  ASSERT_TRUE(b.applier);
  b.run(grip_home, 5);
  EXPECT_LT(displacement(b.clip->pose(), {Vec3::Zero(), Quat::Identity()}).norm(), 1e-9);
  Pose there = displaced(grip_home, (Vec6() << 5e-3, -3e-3, 2e-3, 0.2, -0.1, 0.3).finished());
  for (int i = 1; i <= 30; ++i) b.run(displaced(grip_home, displacement(grip_home, there) * i / 30), 1);
  b.run(there, 200);
  EXPECT_LT((b.clip->grip().p - there.p).norm(), 1e-7);
  EXPECT_LT(rotation_vector(b.clip->grip().q * there.q.conjugate()).norm(), 1e-5);
  EXPECT_LT(b.applier->hand_force().norm(), 1e-5);
}

TEST(ClipApplier, TheHandFeelsTheLoadOnTheClip) {
  Loaded b;
  ASSERT_TRUE(b.applier);
  // A force at the grip: no moment about the applier's tip.
  const Vec3 force(0.1, -0.2, 0.15);
  for (int i = 0; i < 400; ++i) {
    b.clip->external << force, (b.clip->grip().p - b.clip->pose().apply(b.clip->tool().centre_of_mass)).cross(force);
    b.run(grip_home, 1);
  }
  EXPECT_TRUE(test::held("the hand feels the load on its clip", (b.applier->hand_force().head<3>() - force).norm(),
                         force.norm(), 1e-6));
  EXPECT_LT(b.applier->hand_force().tail<3>().norm(), 1e-8);
}

TEST(ClipApplier, OpensWhileTheButtonIsHeldAndTheSpringCloses) {
  Loaded b;
  ASSERT_TRUE(b.applier);
  b.run(grip_home, 6, true);
  EXPECT_NEAR(b.clip->opening(), widest * 6 * b.s->h() / 0.2, 1e-7) << "at a bounded speed";
  b.run(grip_home, 60, true);
  EXPECT_NEAR(b.clip->opening(), widest, 1e-7);
  // The applier bears what the spring presses, at the middle of the blades.
  EXPECT_NEAR(b.clip->stop_force(), b.clip->torque(widest) / test::reference, 1e-3);
  EXPECT_NEAR(b.applier->activity(), 1, 1e-12);
  b.run(grip_home, 90);
  EXPECT_NEAR(b.clip->opening(), 0, 1e-8);
  EXPECT_NEAR(b.applier->activity(), 0, 1e-12);
}

TEST(ClipApplier, AHeldOpenSpringWeakensAsPublished) {
  Loaded b;
  ASSERT_TRUE(b.applier);
  b.run(grip_home, 60, true);
  const double before = b.clip->strength();
  test::Figure figure("weakening", "The spring of a clip held open: 22 % in ten minutes", "time, s",
                      "strength over that at first");
  for (int k = 1; k <= 10; ++k) {
    b.run(grip_home, 60, true);
    figure.law("law", 60 * k * b.s->h(), std::pow(0.78, 60 * k * b.s->h() / 600));
    figure.run("run", 60 * k * b.s->h(), b.clip->strength() / before);
  }
  const double rate = std::log(b.clip->strength() / before) / (600 * b.s->h());
  EXPECT_NEAR(1 - std::exp(600 * rate), 0.22, 1e-6) << "in ten minutes fully open";
  const double after = b.clip->strength();
  b.run(grip_home, 120);
  const double closed = b.clip->strength();
  b.run(grip_home, 120);
  EXPECT_LT(closed, after);
  EXPECT_EQ(b.clip->strength(), closed) << "a closed clip keeps its force";
  b.s->reset();
  EXPECT_EQ(b.clip->strength(), 1);
}

TEST(ClipApplier, LetsGoAndTakesBackWithoutAStepOfForce) {
  Loaded b(std::string(), "");
  ASSERT_TRUE(b.applier);
  b.run(grip_home, 10, true);
  b.run(grip_home, 1, true, true);
  EXPECT_TRUE(b.clip->holder()) << "held open: it is not let go";
  EXPECT_TRUE(said(*b.s, "warning", "applier"));
  b.run(grip_home, 60);
  b.run(grip_home, 1, false, true);
  EXPECT_TRUE(said(*b.s, "clip_released", "clip"));
  EXPECT_FALSE(b.clip->holder());
  EXPECT_TRUE(b.clip->in_field());
  b.run(grip_home, 1, false, true);
  EXPECT_FALSE(b.clip->holder()) << "the button acts once";
  EXPECT_EQ(b.clip->clip_state().applications, 1);
  // Away: out of reach, as the applier's properties say.
  const std::vector<BodyProperty> limits = b.applier->properties();
  ASSERT_EQ(limits.size(), 2u);
  EXPECT_LT(limits[0].value, 9e-3);
  EXPECT_GT(limits[0].value, 2e-3);
  EXPECT_GT(limits[1].value, 0.35);
  const Pose away = displaced(grip_home, (Vec6() << 0, 0, 9e-3, 0, 0, 0).finished());
  const Pose lying = b.clip->pose();
  b.run(away, 30);
  b.run(away, 1, false, true);
  EXPECT_TRUE(said(*b.s, "warning", "applier"));
  EXPECT_LT(displacement(lying, b.clip->pose()).norm(), 1e-12) << "a free clip stays";
  // Back, askew by 2 mm and 20 degrees.
  const Pose askew = displaced(grip_home, (Vec6() << 1.2e-3, -1e-3, 1.2e-3, 0, 0.35, 0).finished());
  b.run(askew, 30);
  EXPECT_LT(b.applier->hand_force().norm(), 1e-9);
  b.run(askew, 1, false, true);
  EXPECT_EQ(b.clip->holder(), b.applier);
  EXPECT_TRUE(said(*b.s, "clip_taken", "clip"));
  Vec6 last = b.applier->hand_force();
  double most = 0;
  for (int i = 0; i < 120; ++i) {
    b.run(askew, 1);
    most = std::max(most, (b.applier->hand_force() - last).head<3>().norm());
    last = b.applier->hand_force();
  }
  EXPECT_LT(most, 0.02) << "N from one step to the next";
  EXPECT_LT((b.clip->grip().p - askew.p).norm(), 1e-6) << "it slid into the jaws";
  EXPECT_LT(rotation_vector(b.clip->grip().q * askew.q.conjugate()).norm(), 1e-4);
}

TEST(ClipApplier, TakesAClipByItsOtherSideButNotFarTurned) {
  for (const auto& [turn, taken] : {std::pair{3.0, true}, {0.6, true}, {1.5, false}}) {
    Loaded b;
    ASSERT_TRUE(b.applier);
    b.run(grip_home, 2);
    ASSERT_EQ(b.s->command("ask", "applier release"), "");
    const Pose device = displaced(grip_home, (Vec6() << 0, 0, 0, 0, 0, turn).finished());
    b.run(device, 60);
    b.run(device, 1, false, true);
    EXPECT_EQ(b.clip->holder() != nullptr, taken) << turn;
    if (!taken) continue;
    const Pose start = b.clip->pose();
    b.run(device, 60);
    const double turned = rotation_vector(b.clip->pose().q * start.q.conjugate()).norm();
    EXPECT_NEAR(turned, std::min(turn, 3.14159265358979 - turn), 1e-4);
  }
}

TEST(ClipApplier, ReleasedClipKeepsHolding) {
  ClipBench b;
  ASSERT_TRUE(b.load(b.strip("3 MPa") + b.clip_element("") + b.applier_element(R"(load="clip")") +
                     R"(<contact between="clip plate" friction="0.35" spacing="0.3 mm" max_contacts="20"/>)"));
  // Open above the strip, down over it, close, let go, away.
  const auto at = [](double z) { return displaced(grip_home, (Vec6() << 0, 0, z, 0, 0, 0).finished()); };
  for (int i = 0; i < 30; ++i) b.run(at(8e-3), 1, true);
  for (int i = 0; i < 30; ++i) b.run(at(8e-3 * (1 - i / 30.0)), 1, true);
  b.run(at(0), 60);
  EXPECT_TRUE(b.clip->touched());
  EXPECT_FALSE(b.applier->why_kept().empty());
  const double force = b.clip->force();
  EXPECT_NEAR(force, b.clip->torque(b.clip->opening()) / test::reference, 1e-6);
  b.run(at(0), 1, false, true);
  const Pose where = b.clip->pose();
  EXPECT_TRUE(b.applier->why_kept().empty());
  b.run(at(10e-3), 120);
  EXPECT_LT((b.clip->pose().p - where.p).norm(), 2e-4) << "it settles into the tissue";
  const Pose rest = b.clip->pose();
  b.run(at(10e-3), 300);
  EXPECT_TRUE(test::held("a released clip stays, m", displacement(rest, b.clip->pose()).norm(), 1, 1e-6));
  EXPECT_NEAR(b.clip->force(), force, 0.02 * force);
  EXPECT_TRUE(b.clip->touched());
  // A hand that has it again pulls it off.
  b.run(at(0), 30);
  b.run(at(0), 1, false, true);
  ASSERT_EQ(b.clip->holder(), b.applier);
  for (int i = 0; i < 60; ++i) b.run(at(i * 2e-4), 1);
  b.run(at(12e-3), 60);
  EXPECT_FALSE(b.clip->touched());
}

TEST(ClipApplier, LoadsFromTheTray) {
  ClipBench b;
  ASSERT_TRUE(b.load(
      b.clip_element("") + R"(<clip id="other" model="meshes/clip/clip.urdf"/>)" +
      R"(<clip_applier id="applier" model="meshes/tool/tool.urdf" hand="right" clips="clip other" home="0 0 14 mm" shaft="0 0 1" flat="1 0 0"/>)" +
      R"(<retractor id="spatula" model="meshes/tool/tool.urdf" hand="right" home="0 0 14 mm" shaft="0 0 1" flat="1 0 0"/>)"));
  auto* other = b.s->scene().find_as<Clip>("other");
  EXPECT_FALSE(b.clip->active());
  b.run(grip_home, 1);
  EXPECT_TRUE(b.clip->clip_state().on_tray);
  EXPECT_EQ(b.s->command("ask", "applier release"), "there is no clip in the applier");
  EXPECT_NE(b.s->command("ask", "applier load clop").find("did you mean \"clip\"?"), std::string::npos);
  EXPECT_EQ(b.s->command("ask", "applier load clip"), "");
  b.run(grip_home, 1);
  EXPECT_TRUE(said(*b.s, "clip_loaded", "clip"));
  EXPECT_TRUE(b.clip->active());
  EXPECT_EQ(b.s->command("ask", "applier load other"), "");
  EXPECT_FALSE(b.clip->active());
  EXPECT_TRUE(other->active());
  b.run(grip_home, 2);
  EXPECT_EQ(b.s->command("ask", "applier release"), "");
  EXPECT_NE(b.s->command("ask", "applier load other").find("is in the field"), std::string::npos);
  EXPECT_EQ(b.s->command("ask", "applier load clip"), "");
  b.run(grip_home, 2);
  // Laid down, its clip goes to the tray; what lies in the field stays there.
  EXPECT_EQ(b.s->command("exchange", "right spatula"), "");
  EXPECT_FALSE(b.clip->active());
  EXPECT_TRUE(other->active());
  EXPECT_NE(b.s->command("ask", "applier load clip"), "");
  b.run(grip_home, 2);
  EXPECT_EQ(b.s->command("exchange", "right applier"), "");
  EXPECT_EQ(b.applier->clip(), nullptr);
  EXPECT_EQ(b.s->command("ask", "applier take"), "");
  EXPECT_EQ(b.applier->clip(), other);
  b.run(grip_home, 2);
  b.s->reset();
  EXPECT_FALSE(other->active());
  EXPECT_EQ(b.applier->clip(), nullptr);
}

TEST(ClipApplier, AClipInAnApplierOnTheTrayComesUpWithIt) {
  ClipBench b;
  ASSERT_TRUE(b.load(
      R"(<retractor id="spatula" model="meshes/tool/tool.urdf" hand="right" home="0 0 14 mm" shaft="0 0 1" flat="1 0 0"/>)" +
      b.applier_element(R"(load="clip")") + b.clip_element("")));
  EXPECT_FALSE(b.clip->active());
  const Pose there = displaced(grip_home, (Vec6() << 3e-3, 0, 5e-3, 0.1, 0, 0).finished());
  b.run(there, 3);
  const std::uint64_t before = b.s->state_hash();
  EXPECT_EQ(b.s->command("exchange", "right applier"), "");
  b.run(there, 3);
  EXPECT_TRUE(b.clip->active());
  EXPECT_LT((b.clip->grip().p - there.p).norm(), 1e-9);
  b.s->reset();
  b.run(there, 3);
  EXPECT_EQ(b.s->state_hash(), before) << "reset leads back";
}

}  // namespace
}  // namespace insula
