// SPDX-License-Identifier: GPL-3.0-or-later
// The clip by itself and on plates: closed forms of its spring, of friction, of a free rigid body.
#include "core/testing/held.h"
#include "plugins/clip/clip_for_test.h"
#include "tests/figures/figure.h"

namespace insula {
namespace {

using test::ClipBench;
using test::closing;
using test::hinge_z;
using test::reference;
using test::slope;

double torque(double opening) { return reference * (closing + slope * 2 * reference * std::sin(opening)); }

TEST(Clip, JawsBalanceTheSpringAtEveryOpeningAndPlaceOfTheBlade) {
  test::Figure figure("jaws", "A clip closed on a bar: the contacts balance the spring", "opening of a jaw, rad",
                      "moment about the hinge, N mm");
  for (double o = 0; o < 0.3; o += 0.01) figure.law("spring", o, torque(o) * 1e3);
  for (const double radius : {1e-3, 2e-3})
    for (const double z : {1.5e-3, 4.5e-3, 7e-3}) {
      SCOPED_TRACE(fmt::format("bar of {} mm at {} mm", radius * 1e3, z * 1e3));
      ClipBench b;
      ASSERT_TRUE(b.load(b.bar(radius, z) + b.clip_element(R"(start="field" start_opening="0.38 rad")") +
                         R"(<contact between="clip plate" friction="0.8"/>)"));
      b.steps(240);
      const double o = b.clip->opening(), x = hinge_z - z;
      EXPECT_NEAR(o, std::asin(radius / x), 0.02) << "the jaws lie on the bar";
      double left, right;
      const double t = torque(o);
      EXPECT_NEAR(b.moment(-1, &left), t, 1e-6 * t);
      figure.run("contacts", o, b.moment(-1) * 1e3);
      EXPECT_NEAR(b.moment(1, &right), t, 1e-6 * t);
      EXPECT_NEAR(left, t / x, 0.2 * left) << "the force falls off along the blade";
      EXPECT_NEAR(b.clip->force(), t / reference, 1e-6 * t / reference);
      EXPECT_NEAR(b.clip->stop_force(), 0, 1e-12);
      EXPECT_TRUE(b.clip->touched());
    }
}

TEST(Clip, ClosedJawsRestOnOneAnother) {
  ClipBench b;
  ASSERT_TRUE(b.load(b.clip_element(R"(start="field" start_opening="0.3 rad")")));
  b.steps(200);
  EXPECT_NEAR(b.clip->opening(), 0, 1e-10);
  EXPECT_NEAR(b.clip->stop_force(), closing, 1e-6);
  EXPECT_NEAR(b.clip->force(), 0, 1e-9);
  EXPECT_FALSE(b.clip->touched());
  ASSERT_EQ(Clips(*b.s).now().size(), 1u);
  EXPECT_FALSE(b.clip->clip_state().on_tray);
  EXPECT_TRUE(b.clip->clip_state().temporary);
}

TEST(Clip, SceneMayChangeTheSpring) {
  ClipBench b;
  ASSERT_TRUE(b.load(b.clip_element(R"(start="field" closing_force="0.8 N" force_slope="100 N/m")")));
  EXPECT_NEAR(b.clip->torque(0.2), reference * (0.8 + 100 * 2 * reference * std::sin(0.2)), 1e-15);
}

TEST(Clip, AFreeClipAtRestStaysToTheBit) {
  ClipBench b;
  ASSERT_TRUE(b.load(b.clip_element(R"(start="field" home="3 -2 5 mm" shaft="0.3 1 0.2" flat="1 0 0")")));
  b.steps(1);
  const Pose start = b.clip->pose();
  b.steps(600);
  EXPECT_LT(displacement(start, b.clip->pose()).norm(), 1e-15);
  EXPECT_NEAR(b.clip->opening(), 0, 1e-10);
}

TEST(Clip, MomentumIsThatOfARigidBody) {
  ClipBench b;
  ASSERT_TRUE(b.load(b.clip_element(R"(start="field" drag="0 1/s")")));
  const Vec3 force(2e-3, -1e-3, 3e-3), moment(4e-5, 8e-5, -4e-5);
  b.clip->external << force, moment;
  const auto centre = [&] { return b.clip->pose().apply(b.clip->tool().centre_of_mass); };
  const Vec3 from = centre();
  b.steps(10);
  const double h = b.s->h();
  EXPECT_TRUE(test::held("momentum of a clip", (b.clip->momentum() - 10 * h * force).norm(), force.norm(), 1e-12));
  EXPECT_TRUE(
      test::held("angular momentum of a clip", (b.clip->spin() - 10 * h * moment).norm(), moment.norm(), 1e-12));
  // sum over k of k h force/m h: the discrete law.
  EXPECT_LT((centre() - from - 55 * h * h / 0.03 * force).norm(), 1e-12);
  b.clip->external.setZero();
  const Vec3 momentum = b.clip->momentum(), spin = b.clip->spin(), at = centre();
  b.steps(60);
  EXPECT_LT((b.clip->momentum() - momentum).norm(), 1e-13 * momentum.norm());
  EXPECT_LT((b.clip->spin() - spin).norm(), 1e-13 * spin.norm());
  EXPECT_LT((centre() - at - 60 * h / 0.03 * momentum).norm(), 1e-11);
  EXPECT_GT(displacement({Vec3::Zero(), Quat::Identity()}, {Vec3::Zero(), b.clip->pose().q}).norm(), 0.1)
      << "it should have turned";
}

TEST(Clip, FallsByItsTrueWeightAndTheFluidTakesItsMotion) {
  ClipBench b;
  ASSERT_TRUE(b.load(b.clip_element(R"(start="field" drag="2 1/s")"), R"(gravity="0 0 -9.81 m/s2")"));
  b.steps(600);
  // Terminal speed: m_true g = drag * inertia * v.
  const double v = -b.clip->momentum().z() / 0.03;
  EXPECT_TRUE(test::held("terminal speed of a clip", std::abs(v - 0.00014 * 9.81 / (2 * 0.03)), v, 1e-6));
}

// A hard strip is pulled across the blades, which hold it by friction on both faces, 2 mu N. A part of this keeps the
// strip in the wedge of the blades (half angle o): each face has the force P/2 across and N tan(o) along. So
// P = 2 N sqrt(mu^2 - tan(o)^2).
TEST(Clip, HoldsAndSlipsAtTwiceTheFriction) {
  constexpr double mu = 0.3;
  for (const double pull : {0.98, 1.02}) {
    ClipBench b;
    ASSERT_TRUE(
        b.load(b.strip("200 MPa") + b.clip_element(R"(start="field" start_opening="0.1 rad")") +
               fmt::format(R"(<contact between="clip plate" friction="{}" spacing="0.3 mm" max_contacts="20"/>)", mu)));
    b.steps(240);
    // Through the middle of the pressure, so that nothing turns the clip.
    double squeeze = 0;
    Vec3 middle = Vec3::Zero();
    for (const ContactPoint& c : b.s->report().contacts) {
      squeeze += c.normal_force;
      middle += c.normal_force * c.position;
    }
    middle /= squeeze;
    EXPECT_TRUE(test::held("squeeze of a pulled clip",
                           std::abs(squeeze - 2 * b.clip->torque(b.clip->opening()) / (hinge_z - middle.z())), squeeze,
                           0.02));
    const Vec3 force(0, pull * squeeze * std::sqrt(mu * mu - std::pow(std::tan(b.clip->opening()), 2)), 0);
    b.clip->external << force, (middle - b.clip->pose().apply(b.clip->tool().centre_of_mass)).cross(force);
    b.steps(60);
    const Vec3 before = b.clip->pose().p;
    b.steps(60);
    const double slid = (b.clip->pose().p - before).norm();
    if (pull < 1) EXPECT_LT(slid, 1e-6) << "it must hold";
    else EXPECT_GT(slid, 1e-4) << "it must slip";
  }
}

TEST(Clip, EnergyNeverExceedsThatOfTheOpenSpring) {
  ClipBench b;
  ASSERT_TRUE(b.load(b.bar(1e-3, 3e-3) + b.clip_element(R"(start="field" start_opening="0.39 rad")") +
                     R"(<contact between="clip plate" friction="0.3" spacing="0.4 mm" max_contacts="40"/>)"));
  const double start = b.clip->energy();
  for (int i = 0; i < 120; ++i) {
    b.steps(1);
    EXPECT_LE(b.clip->energy(), start) << "step " << i;
  }
  const double held = b.clip->energy();
  EXPECT_LT(held, start);
  for (int i = 0; i < 300; ++i) {
    b.steps(1);
    EXPECT_NEAR(b.clip->energy(), held, 1e-3 * held) << "step " << i;
  }
}

TEST(Clip, SaysWhatIsWrong) {
  ClipBench b;
  const auto message = [&](const std::string& elements) {
    const auto r =
        load_simulation_text("<scene>" + elements + "</scene>", b.folder.path() / "scene.xml", test::builtin(), 1);
    EXPECT_FALSE(r.simulation);
    return r.diagnostics.format();
  };
  EXPECT_NE(message(R"(<clip id="clip" model="meshes/tool/tool.urdf"/>)").find("is no clip"), std::string::npos);
  EXPECT_NE(message(b.clip_element(R"(start_opening="0.9 rad")")).find("open by no more"), std::string::npos);
  EXPECT_NE(message(b.clip_element(R"(flat="0 0 2")")).find("parallel"), std::string::npos);
  EXPECT_NE(message(b.clip_element(R"(shaft="0 0 0")")).find("zero"), std::string::npos);
  EXPECT_NE(message(b.clip_element("") + R"(<clip id="other" model="meshes/clip/clip.urdf"/>)" +
                    b.applier_element(R"(load="other")"))
                .find("none of its clips"),
            std::string::npos);
  EXPECT_NE(
      message(b.clip_element(R"(start="field")") + b.applier_element(R"(load="clip")")).find("starts in the field"),
      std::string::npos);
  EXPECT_NE(
      message(
          b.clip_element("") + b.applier_element(R"(load="clip")") +
          R"(<clip_applier id="second" model="meshes/tool/tool.urdf" hand="left" clips="clip" load="clip" home="0 0 0 m" shaft="0 0 1" flat="1 0 0"/>)")
          .find("in the applier"),
      std::string::npos);
}

}  // namespace
}  // namespace insula
