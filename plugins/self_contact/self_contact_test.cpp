// SPDX-License-Identifier: GPL-3.0-or-later
// Walls of a thin vessel pressed flat by jaws and met by fast blades: they never go through one another.
#include <gtest/gtest.h>

#include "core/testing/held.h"
#include "plugins/self_contact/vessel_for_test.h"

namespace insula {
namespace {

using test::VesselBench;

std::vector<std::uint64_t> ids(const Simulation& s) {
  std::vector<std::uint64_t> out;
  for (const Block& k : s.problem().blocks) out.push_back(k.id);
  std::sort(out.begin(), out.end());
  return out;
}

// A tube between two jaws that end 8 mm beyond the middle: about 2 N on either side.
struct Jaws : VesselBench {
  explicit Jaws(const std::string& self_contact)
      : VesselBench(
            test::tube(2e-3, 16e-3, 17), 7.6e-3,
            R"(<retractor id="up" model="meshes/jaw/tool.urdf" hand="right" home="0 -4.5 5 mm" shaft="0 1 0" flat="0 0 1" coupling="250 N/m"/>
<retractor id="down" model="meshes/jaw/tool.urdf" hand="left" home="0 -4.5 -5 mm" shaft="0 1 0" flat="0 0 1" coupling="250 N/m"/>)",
            "up down", R"(friction="0.2" contact_geometry="vertices" max_contacts="40" alarm="0.3 mm")", self_contact,
            400) {}
  /// Step i of closing in 90 steps, then staying.
  void close(int i) {
    for (int which = 0; which < 2; ++which) {
      Pose at = s->instrument_of(which)->home_pose();
      at.p.z() = (which == 1 ? 1 : -1) * (5e-3 - 13e-3 * std::min(1.0, i / 90.0));
      hand(which, at);
    }
    s->step();
  }
  double apart() const { return s->instrument_of(1)->pose().p.z() - s->instrument_of(0)->pose().p.z(); }
};

TEST(SelfContact, JawsPressAVesselFlatAndItsWallsStayApart) {
  Jaws b(R"(thickness="0.3 mm")");
  ASSERT_TRUE(b.s);
  for (int i = 0; i < 210; ++i) {
    b.close(i);
    ASSERT_EQ(b.crossings(), 0) << i;
    for (int hand : {0, 1}) ASSERT_LT(b.depth(*b.s->instrument_of(hand)), 0.1e-3) << i;
    ASSERT_LE(b.self->rows(), 60);
    ASSERT_TRUE(b.s->report().finite);
  }
  for (const Proximity& x : b.self->contacts()) EXPECT_GT(x.gap, -0.1e-3);
  // Jaws of 1 mm with two walls of 0.3 mm between them.
  const double apart = b.apart();
  EXPECT_NEAR(apart, 1.6e-3, 0.1e-3);

  const auto before = ids(*b.s);
  int changed = 0;
  for (int i = 0; i < 120; ++i) {
    b.close(300);
    changed += ids(*b.s) != before;
  }
  EXPECT_EQ(changed, 0);
  std::size_t contacts = 0;
  for (const Contact::Pair& p : b.touch->pairs()) {
    if (p.tool_b) continue;
    contacts += p.contacts.size();
    Vec3 push = Vec3::Zero();
    for (std::size_t i = 0; i < p.contacts.size(); ++i) push += p.forces[i][0] * p.contacts[i].normal;
    EXPECT_NEAR(push.z(), p.tool_a->id == "up" ? 2.0 : -2.0, 0.25);
  }
  EXPECT_GE(contacts, 40u);
}

// 0.5 m/s, tip first, edge first and flat: in a step the hand moves twice as far as the vessel is wide.
// The walls' own force on one another is the layer's law; what they bear together is what the jaws press with.
TEST(SelfContact, AWallThatGivesWayBearsItsStiffnessTimesTheOverlap) {
  constexpr double layer = 3000;
  Jaws b(R"(thickness="0.3 mm" contact_stiffness="3 kN/m")");
  ASSERT_TRUE(b.s);
  for (int i = 0; i < 330; ++i) {
    b.close(i);
    ASSERT_EQ(b.crossings(), 0) << i;
  }
  double sum = 0;
  int bearing = 0;
  for (const ContactPoint& c : b.s->report().contacts) {
    if (c.a != b.shell || c.b != b.shell) continue;
    EXPECT_TRUE(test::held("a wall bears its layer's force, N",
                           std::abs(c.normal_force - layer * std::max(0.0, -c.gap)), 1, 1e-5))
        << c.gap;
    sum += c.normal_force * std::abs(c.normal.z());
    bearing += c.normal_force > 0.05;
  }
  EXPECT_GT(bearing, 4);
  const double apart = b.apart();
  EXPECT_LT(apart, 1.55e-3);
  EXPECT_GT(apart, 1.1e-3);
  EXPECT_GT(sum, 1.0);
}

TEST(SelfContact, FastBladesPressNoWallThroughTheOtherAndStayOutside) {
  const std::string blade =
      R"(<retractor id="blade" model="meshes/blade/tool.urdf" hand="right" home="0 0 30 mm" shaft="0 0 1" flat="1 0 0" coupling="250 N/m"/>)";
  VesselBench b(test::tube(2e-3, 12e-3, 15), 5.8e-3, blade, "blade",
                R"(friction="0.2" spacing="0.7 mm" max_contacts="24")", R"(thickness="0.3 mm")", 100);
  ASSERT_TRUE(b.s);
  auto* tool = b.s->scene().find_as<Instrument>("blade");
  shapes::Random r(7);
  const double step = 0.5 * b.s->h();
  constexpr int poses = 1000;
  int touched = 0;
  double deepest = 0;
  for (int k = 0; k < poses; ++k) {
    const Vec3 target(r.between(-3e-3, 3e-3), r.between(-1e-3, 1e-3), r.between(-1e-3, 1e-3));
    Vec3 d = r.direction();
    d.x() *= 0.5;
    d.normalize();
    const Vec3 turn = r.in_box(0.3), spin = r.direction();
    const double start = r.between(0, step);
    b.s->reset();
    const Vec3 z = k % 3 == 0 ? Vec3(-d) : d.cross(spin).normalized();
    const Vec3 x = k % 3 == 1 ? d.cross(z) : k % 3 == 2 ? d : d.cross(spin).normalized();
    Mat3 axes;
    axes << x, z.cross(x), z;
    Pose at;
    at.q = (from_rotation_vector(turn) * Quat(axes)).normalized();
    at.p = target - d * (7e-3 + start);
    if (k % 3 != 0) at.p -= 6e-3 * (at.q * Vec3::UnitZ());
    tool->place(at);
    b.hand(1, at);
    if (b.depth(*tool) > 0) continue;
    for (int i = 0; i < 6; ++i) {
      if (i < 3) at.p += step * d;
      b.hand(1, at);
      b.s->step();
      ASSERT_EQ(b.crossings(), 0) << "pose " << k << " step " << i;
      deepest = std::max(deepest, b.depth(*tool));
      bool touches = false;
      for (const ContactPoint& c : b.s->report().contacts) touches = touches || c.normal_force > 0;
      touched += touches;
    }
  }
  EXPECT_LT(deepest, 0.1e-3);
  EXPECT_GT(touched, 4 * poses);
}

// 0.6 mm a step along the vessel, which is twice the limit of motion into a wall: nothing but the wall holds it back.
TEST(SelfContact, AHandThatDrawsABladeAlongAVesselIsNotHeldBack) {
  const std::string blade =
      R"(<retractor id="blade" model="meshes/blade/tool.urdf" hand="right" home="-5 0 2.5 mm" shaft="0 0 1" flat="1 0 0" coupling="250 N/m"/>)";
  VesselBench b(test::tube(2e-3, 16e-3, 17), 7.6e-3, blade, "blade", R"(friction="0")", R"(thickness="0.3 mm")", 100);
  ASSERT_TRUE(b.s);
  const Instrument& tool = *b.s->instrument_of(1);
  Pose at = tool.home_pose();
  const auto step = [&](double along, double down) {
    at.p += Vec3(along, 0, -down);
    b.hand(1, at);
    b.s->step();
  };
  for (int i = 0; i < 30; ++i) step(0, 0.02e-3);
  for (int i = 0; i < 30; ++i) step(0, 0);
  const double pressed = tool.hand_force()[2];
  ASSERT_GT(pressed, 5e-3);
  for (int i = 0; i < 12; ++i) {
    step(0.6e-3, 0);
    EXPECT_LT(std::abs(tool.hand_force()[0]), 0.02) << "facets of the vessel, step " << i;
  }
}

// 0.45 mm inward in one step, which is more than the limit into a wall, and not so deep that the wall would invert.
TEST(SelfContact, AHandThatTapsAVesselIsNotHeldBack) {
  const std::string ball =
      R"(<retractor id="ball" model="meshes/ball/tool.urdf" hand="right" home="0 0 3.5 mm" shaft="0 0 1" flat="1 0 0" coupling="2000 N/m"/>)";
  VesselBench b(test::tube(2e-3, 16e-3, 17), 7.6e-3, ball, "ball", R"(friction="0")", R"(thickness="0.3 mm")", 100);
  ASSERT_TRUE(b.s);
  const Instrument& tool = *b.s->instrument_of(1);
  Pose at = tool.home_pose();
  const auto step = [&](double down) {
    at.p.z() -= down;
    b.hand(1, at);
    b.s->step();
    return tool.hand_force()[2];
  };
  while (step(0.01e-3) < 1e-3) ASSERT_GT(at.p.z(), 0) << "nothing was touched";
  const double tapped = step(0.45e-3);
  double held = 0;
  for (int i = 0; i < 100; ++i) held = step(0);
  EXPECT_GT(held, 5e-3);
  EXPECT_LT(tapped, 2 * held) << "a wall without pressure softens as it is dented";
}

TEST(SelfContact, ASurfaceThatCannotTouchItselfIsRefused) {
  test::SceneFolder folder;
  folder.write("meshes/tube.obj", test::obj_text(test::tube(2e-3, 8e-3, 12)));
  auto r = load_simulation_text(
      R"(<scene><obstacle id="still"><surface id="wall" mesh="meshes/tube.obj" mesh_unit="m"/></obstacle>
<self_contact on="wall"/></scene>)",
      folder.path() / "scene.xml", test::builtin(), 1);
  EXPECT_FALSE(r.simulation);
  EXPECT_NE(r.diagnostics.format().find("never moves"), std::string::npos);
}

}  // namespace
}  // namespace insula
