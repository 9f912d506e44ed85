// SPDX-License-Identifier: GPL-3.0-or-later
// What bounds a contact: a compliant layer, the most that two tissues bear, how far a tool goes on in tissue.
#include "core/testing/held.h"
#include "plugins/contact/contact_for_test.h"

namespace insula {
namespace {

using test::Bench;
using test::SceneFolder;

/// A square blade over vertices half a millimetre apart, contacts sharing friction.
struct BladeBench : Bench {
  explicit BladeBench(const std::string& limit)
      : Bench(R"(<robot name="blade"><link name="tool"><inertial><mass value="0.02"/>
<inertia ixx="1e-6" iyy="1e-6" izz="1e-6" ixy="0" ixz="0" iyz="0"/></inertial>
<collision name="blade"><origin xyz="0 0 0.001"/><geometry><box size="0.0065 0.0065 0.002"/></geometry></collision></link></robot>)",
              shapes::box(Vec3(-0.01, -0.01, -0.01), Vec3(0.01, 0.01, 0), 20), test::upright,
              R"(friction="0.3" contact_geometry="vertices" patch="2 mm" spacing="0.5 mm" max_contacts="100" )" +
                  limit) {}
};

// Four feet on layers, and the coupling over them: springs in series.
TEST(ContactLimits, ForceOfALayerIsItsStiffnessTimesTheOverlap) {
  constexpr double coupling = 400, dz = 1e-3;
  for (const double layer : {200.0, 2000.0, 50000.0})
    for (const double friction : {0.0, 0.3}) {
      SCOPED_TRACE(fmt::format("layer {} N/m, friction {}", layer, friction));
      Bench b(test::feet_urdf(5e-3, test::radius), test::ground(), test::upright,
              fmt::format(R"(friction="{}" contact_stiffness="{} N/m")", friction, layer));
      ASSERT_TRUE(b.tool);
      Pose down = b.tool->home_pose();
      down.p.z() = test::radius - dz;
      for (int i = 0; i < 200; ++i) b.move_to(down);
      const double overlap = coupling * dz / (4 * layer + coupling);
      EXPECT_NEAR(test::radius - b.tool->pose().p.z(), overlap, 1e-6 * overlap);
      const auto& contacts = b.s->report().contacts;
      ASSERT_EQ(contacts.size(), 4u);
      for (const ContactPoint& c : contacts) {
        EXPECT_NEAR(c.normal_force, layer * -c.gap, 1e-6 * layer * overlap);
        EXPECT_TRUE(test::held("force of a layer", std::abs(c.normal_force - layer * overlap), layer * overlap, 1e-6));
      }
    }
}

// The same by vertices, with contacts of a blade that share friction forces.
TEST(ContactLimits, ForceOfALayerUnderABladeWithPatches) {
  constexpr double coupling = 400, dz = 1e-3, layer = 500;
  BladeBench b(fmt::format(R"(contact_stiffness="{} N/m")", layer));
  ASSERT_TRUE(b.tool);
  Pose down = b.tool->home_pose();
  down.p.z() = -dz;
  for (int i = 0; i < 200; ++i) b.move_to(down);
  double sum = 0;
  int bearing = 0;
  for (const ContactPoint& c : b.s->report().contacts) {
    EXPECT_NEAR(c.normal_force, layer * std::max(0.0, -c.gap), 1e-6 * layer * 1e-4);
    if (c.normal_force <= 0) continue;
    ++bearing;
    sum += c.normal_force * c.normal.z();
  }
  EXPECT_GE(bearing, 36);
  EXPECT_NEAR(sum, coupling * (b.tool->pose().p.z() + dz), 1e-6 * coupling * dz);
}

// Four feet that the hand presses on with more than they bear: the coupling gives what they do bear, and they go in.
TEST(ContactLimits, AFootBearsSoMuchAndGoesIn) {
  constexpr double coupling = 400, dz = 1e-3;
  for (const double bound : {0.02, 0.07, 0.3}) {
    SCOPED_TRACE(fmt::format("{} N", bound));
    Bench b(test::feet_urdf(5e-3, test::radius), test::ground(), test::upright,
            fmt::format(R"(friction="0" max_force="{} N")", bound));
    ASSERT_TRUE(b.tool);
    Pose down = b.tool->home_pose();
    down.p.z() = test::radius - dz;
    for (int i = 0; i < 200; ++i) b.move_to(down);
    const double force = std::min(bound, coupling * dz / 4), overlap = dz - 4 * force / coupling;
    EXPECT_NEAR(test::radius - b.tool->pose().p.z(), overlap, 1e-6 * dz);
    ASSERT_EQ(b.s->report().contacts.size(), 4u);
    double sum = 0;
    for (const ContactPoint& c : b.s->report().contacts) {
      EXPECT_LE(c.normal_force, bound * (1 + 1e-9));
      sum += c.normal_force;
    }
    EXPECT_NEAR(sum, 4 * force, 4e-6 * force);
    down.p.z() = test::radius + 3e-3;
    for (int i = 0; i < 200; ++i) b.move_to(down);
    EXPECT_NEAR(b.tool->pose().p.z(), down.p.z(), 1e-9) << "and out again";
  }
}

// Friction of a bounded contact has rows of its own. Below the bound the law is the same: the feet stick, then slip.
TEST(ContactLimits, ABoundThatIsNotReachedChangesNothingWithFriction) {
  const auto slide = [](const std::string& limit, std::vector<Vec3>& path) {
    Bench b(test::feet_urdf(5e-3, test::radius), test::ground(), test::upright, R"(friction="0.3" )" + limit);
    ASSERT_TRUE(b.tool);
    Pose to = b.tool->home_pose();
    to.p.z() = test::radius - 1e-3;
    for (int i = 0; i < 150; ++i) {
      if (i >= 60) to.p.x() += 2e-5;
      b.move_to(to);
      path.push_back(b.tool->pose().p);
    }
  };
  std::vector<Vec3> freely, bounded;
  slide("", freely);
  slide(R"(max_force="5 N")", bounded);
  ASSERT_EQ(freely.size(), bounded.size());
  ASSERT_FALSE(freely.empty());
  EXPECT_LT(std::abs(freely[64].x()), 1e-7) << "they stick";
  EXPECT_GT(freely.back().x(), 0.2e-3) << "they slip";
  for (std::size_t i = 0; i < freely.size(); ++i) EXPECT_LT((freely[i] - bounded[i]).norm(), 1e-9) << i;
}

// By vertices, with friction that contacts share.
TEST(ContactLimits, AVertexUnderABladeBearsSoMuch) {
  constexpr double coupling = 400, dz = 1e-3, bound = 1e-3;
  BladeBench b(fmt::format(R"(max_force="{} N")", bound));
  ASSERT_TRUE(b.tool);
  Pose down = b.tool->home_pose();
  down.p.z() = -dz;
  for (int i = 0; i < 200; ++i) b.move_to(down);
  double sum = 0;
  for (const ContactPoint& c : b.s->report().contacts) {
    EXPECT_LE(c.normal_force, 1.1 * bound);  // its share of the friction may lie along its own normal
    sum += c.normal_force * c.normal.z() + c.tangent_force.z();
  }
  EXPECT_GT(sum, 25 * bound);
  EXPECT_NEAR(sum, coupling * (b.tool->pose().p.z() + dz), 1e-6 * coupling * dz);
  EXPECT_LT(b.tool->pose().p.z(), -0.1e-3);
}

double max_force(const std::string& contact, double* overlap = nullptr) {
  SceneFolder folder;
  auto s = test::soft_bench(
      folder,
      R"(<contact between="pad top" friction="0" tissue_spacing="3 mm" tissue_max_contacts="60" )" + contact + R"(/>
<contact between="right top" friction="0.1"/>)");
  EXPECT_TRUE(s);
  double most = 0;
  for (int i = 0; i < 150; ++i) {
    test::press(*s, i);
    s->step();
    EXPECT_TRUE(s->report().finite);
    for (const ContactPoint& c : s->report().contacts) {
      if (c.a->id == "right" || c.b->id == "right") continue;
      most = std::max(most, c.normal_force);
      if (overlap) *overlap = std::max(*overlap, -c.gap);
    }
  }
  return most;
}

// A blunt tool presses one soft block on the other.
TEST(ContactLimits, AContactOfTwoTissuesBearsSoMuchAndNoMore) {
  double overlap = 0, overlap_freely = 0;
  const double freely = max_force("", &overlap_freely);
  ASSERT_GT(freely, 0);
  const double bound = 0.03 * freely;
  EXPECT_NEAR(max_force(fmt::format(R"(tissue_max_force="{} N")", bound), &overlap), bound, 1e-6 * bound);
  EXPECT_GT(overlap, overlap_freely + 0.1e-3) << "with more they go through one another";
  const double loose = 2 * freely;
  EXPECT_NEAR(max_force(fmt::format(R"(tissue_max_force="{} N")", loose)), freely, 1e-6 * freely)
      << "a bound that is not reached changes nothing";
}

std::unique_ptr<Simulation> pad_bench(SceneFolder& folder, double most, double friction) {
  folder.write("meshes/pad.msh",
               test::gmsh_text(test::block_mesh({6, 6, 4}, Vec3(-0.015, -0.015, -0.02), Vec3(0.015, 0.015, 0))));
  folder.write("meshes/tool/tool.urdf", test::test_tool_urdf(test::radius));
  return test::load_text(
      fmt::format(
          R"(<scene>{}<retractor id="tool" model="meshes/tool/tool.urdf" hand="right" home="0 0 1 mm" shaft="0 0 1" flat="1 0 0" coupling="2000 N/m"/>
<solver max_sweeps="2000" tolerance="1e-12 m"/><contact between="tool pad" friction="{}" tissue_max_step_displacement="{} m"/></scene>)",
          test::pad, friction, most),
      folder.path() / "scene.xml");
}

/// The hand rests on the pad, pressed in by a fifth of a millimetre.
HandState rest_on_pad(Simulation& s) {
  HandState hand;
  hand.present = true;
  hand.device = s.instrument_of(1)->home_pose();
  hand.device.p.z() -= 0.2e-3;
  for (int i = 0; i < 60; ++i) {
    s.set_hand(1, hand);
    s.step();
  }
  return hand;
}

// The hand leaps 20 mm into the pad and across it, from rest on it: the tool goes in by tissue_max_step_displacement a
// step as long as it touches.
TEST(ContactLimits, AFastToolGoesOnInTissueByNoMoreThanTissuePush) {
  for (const Vec3& leap : {Vec3(0, 0, -0.02), Vec3(0.014, 0, -0.014)})
    for (const double push : {0.5e-3, 1.5e-3, 100e-3}) {
      SCOPED_TRACE(fmt::format("{} mm down, push {} mm", -1e3 * leap.z(), 1e3 * push));
      SceneFolder folder;
      auto s = pad_bench(folder, push, 0.2);
      ASSERT_TRUE(s);
      const Instrument* tool = s->instrument_of(1);
      HandState state = rest_on_pad(*s);
      ASSERT_FALSE(s->report().contacts.empty());
      const Vec3 from = state.device.p;
      state.device.p += leap;
      double deepest = 0;
      for (int i = 0; i < 8; ++i) {
        const Vec3 before = tool->pose().p;
        const bool touches = !s->report().contacts.empty() && s->report().contacts[0].normal_force > 0;
        s->set_hand(1, state);
        s->step();
        ASSERT_TRUE(s->report().finite);
        if (touches) deepest = std::max(deepest, before.z() - tool->pose().p.z());
      }
      EXPECT_GT((tool->pose().p - from).norm(), std::min(3 * push, 2e-3)) << "it goes on in the steps that follow";
      if (push < 0.01) {
        EXPECT_LT(deepest, push * (1 + 1e-3)) << "the pad tilts a little";
        EXPECT_GT(deepest, 0.5 * push);
      } else {
        EXPECT_GT(deepest, 2e-3) << "nothing to hold back, so the rest of this test says nothing";
      }
    }
}

// A tool without mass is with a hand that leaves, at any speed: no contact opposes its motion, so nothing limits it.
TEST(ContactLimits, AHandThatLeavesIsNotPulled) {
  for (const Vec3& leap : {Vec3(0, 0, 8e-3), Vec3(3e-3, 0, 8e-3)}) {
    SCOPED_TRACE(fmt::format("{} mm across, {} mm out", 1e3 * leap.x(), 1e3 * leap.z()));
    SceneFolder folder;
    auto s = pad_bench(folder, 0.05e-3, 0);
    ASSERT_TRUE(s);
    HandState hand = rest_on_pad(*s);
    const Instrument* tool = s->instrument_of(1);
    const double pressed = tool->hand_force()[2];
    ASSERT_GT(pressed, 1e-3);
    for (int i = 0; i < 10; ++i) {
      hand.device.p += 0.1 * leap;
      s->set_hand(1, hand);
      s->step();
      const Vec6 force = tool->hand_force();
      EXPECT_GT(force[2], -1e-6 * pressed) << "towards the pad, step " << i;
      EXPECT_LT(std::abs(force[0]), 0.2 * pressed) << "across, step " << i;
    }
  }
}

}  // namespace
}  // namespace insula
