// SPDX-License-Identifier: GPL-3.0-or-later
// Strands against the closed form of the discretised law; cutting and tearing; generation.
#include <gtest/gtest.h>

#include <fmt/format.h>

#include <cmath>

#include "core/mechanics/obstacle.h"
#include "core/testing/block_mesh.h"
#include "core/testing/example.h"
#include "core/testing/held.h"
#include "plugins/strand_springs/strand_springs.h"
#include "tests/figures/figure.h"

namespace insula {
namespace {

constexpr double a = 0.01, gap = 0.02;  // height of a tetrahedron, from its apex to what the strand leads to
constexpr double young = 1000, poisson = 0.3, density = 1000, alpha = 2, beta = 0.01;
constexpr double mu = young / (2 * (1 + poisson)), lame = young * poisson / ((1 + poisson) * (1 - 2 * poisson));
constexpr double volume = a * a * a / 6, spring = volume * (2 * mu + lame) / (a * a), mass = density * volume / 4;
constexpr double h = 0.01;

/// A tetrahedron on three fixed nodes whose apex, on the z axis, is a linear spring along z; and `other`.
std::string scene(const std::string& strands, const std::string& other) {
  return fmt::format(R"(<scene time_step="10 ms">
  <solver tolerance="1e-15 m" max_sweeps="10000"/>
  <soft_body id="mass" mesh="meshes/tet.msh" mesh_unit="m">
    <corotational_fem young="{} Pa" poisson="{}" density="{} kg/m3" rayleigh_mass="{} 1/s" rayleigh_stiffness="{} s"/>
    <fixed region="beyond" centre="0 0 0.005 m" normal="0 0 -1"/>
  </soft_body>
  {}
  <strand_springs id="strands" {}/>
</scene>)",
                     young, poisson, density, alpha, beta, other, strands);
}

struct Bed {
  test::SceneFolder folder;
  std::unique_ptr<Simulation> s;
  StrandSprings* strands = nullptr;
  Bed(const std::string& attributes, const std::string& other) {
    folder.write("meshes/tet.msh", test::gmsh_text(test::single_tet(a)));
    TetMesh flipped = test::single_tet(a);
    for (Vec3& x : flipped.nodes) x = Vec3(x.x(), -x.y(), 2 * a + gap - x.z());
    folder.write("meshes/flipped.msh", test::gmsh_text(flipped));
    s = test::load_text(scene(attributes, other), folder.path() / "strand.xml");
    if (s) strands = s->scene().find_as<StrandSprings>("strands");
  }
  MaterialPoint apex(const char* id) const {
    MaterialPoint p;
    p.body = s->scene().find_as<Body>(id);
    p.count = 1;
    p.node[0] = 3;
    p.weight[0] = 1;
    return p;
  }
  MaterialPoint wall(const Vec3& at) const {
    MaterialPoint p;
    p.body = s->scene().find_as<Body>("wall");
    p.local = at;
    return p;
  }
  double height(const char* id) const { return s->scene().find_as<SoftBody>(id)->q()[11]; }
};

TEST(StrandSprings, PullsAsTheDiscretisedLawSays) {
  test::Figure figure("strand", "A mass on a strand: one stretched, one slack (nothing pulls)", "step",
                      "displacement, mm");
  for (const bool both : {false, true}) {
    for (const double slack : {0.8, 1.0, 1.3}) {
      Bed t(fmt::format("stiffness=\"30 N/m\" slack=\"{}\" load_direction=\"{}\"", slack, both ? "both" : "tension"),
            "<obstacle id=\"wall\"/>");
      ASSERT_TRUE(t.strands);
      t.strands->add_strand(t.apex("mass"), t.wall(Vec3(0, 0, a + gap)));
      const double k = 30, rest = slack * gap;
      double u = 0, v = 0;
      for (int n = 1; n <= 200; ++n) {
        t.s->step();
        const double inertia = mass / (h * h) + alpha * mass / h + (1 + beta / h) * spring,
                     b = -spring * u + mass * v / h;
        double dq = b / inertia, tension = 0;
        if (both || gap - u - dq > rest) {  // stretched at the end of the free step
          dq = (b + k * (gap - u - rest)) / (inertia + k);
          tension = k * (gap - u - dq - rest);
        }
        u += dq;
        v = dq / h;
        ASSERT_NEAR(t.height("mass") - a, u, 1e-9 * gap) << "step " << n << " slack " << slack;
        if (!both && slack != 1 && n <= 20) {
          const std::string curve = slack < 1 ? "0.8 of its length" : "1.3 of its length";
          figure.law(curve, n, u * 1e3);
          figure.run(curve, n, (t.height("mass") - a) * 1e3);
        }
        ASSERT_NEAR(t.strands->strand(0).tension, tension, 1e-9 * k * gap) << "step " << n << " slack " << slack;
      }
      if (slack > 1 && !both) {
        EXPECT_EQ(u, 0);
      }
      if (slack > 1 && both) {
        EXPECT_LT(u, -1e-4);
      }
      if (slack < 1) {
        EXPECT_GT(u, 1e-4);
      }
    }
  }
}

// F = k (l - l0) in series with the two bodies' own springs.
TEST(StrandSprings, TwoBodiesInEquilibrium) {
  Bed t("stiffness=\"20 N/m\" slack=\"0.7\"",
        fmt::format(R"(<soft_body id="second" mesh="meshes/flipped.msh" mesh_unit="m">
    <corotational_fem young="{} Pa" poisson="{}" density="{} kg/m3" rayleigh_mass="0 1/s" rayleigh_stiffness="{} s"/>
    <fixed region="beyond" centre="0 0 0.035 m" normal="0 0 1"/></soft_body>)",
                    2 * young, poisson, density, beta));
  ASSERT_TRUE(t.strands);
  t.strands->add_strand(t.apex("second"), t.apex("mass"));
  for (int n = 0; n < 1500; ++n) t.s->step();
  const double expected = (1 - 0.7) * gap / (1 / 20.0 + 1 / spring + 1 / (2 * spring));
  EXPECT_TRUE(test::held("strand in series with two springs", std::abs(t.strands->strand(0).tension - expected),
                         expected, 1e-6));
  EXPECT_NEAR(t.height("mass") - a, expected / spring, 1e-6 * expected / spring);
  EXPECT_NEAR(a + gap - t.height("second"), expected / (2 * spring), 1e-6 * expected / spring);
  const double length = t.height("second") - t.height("mass");
  EXPECT_NEAR(t.strands->strand(0).tension, 20 * (length - 0.7 * gap), 1e-6 * expected);
}

/// A strand along z between two fixed points, and a blade whose edge lies across it, 0.45 mm off, to be moved along -x.
struct CutBed : Bed {
  Instrument* knife = nullptr;
  explicit CutBed(const std::string& attributes, const std::string& sharp = "always")
      : Bed(attributes, "<obstacle id=\"wall\"/>") {
    folder.write("meshes/knife/knife.urdf", test::test_tool_urdf(0.0005));
    folder.write("meshes/knife/tool.json", test::test_tool_json(0.003, 0));
    s = test::load_text(
        scene(attributes, R"(<obstacle id="wall"/><dissector id="knife" model="meshes/knife/knife.urdf" hand="right"
      home="0.45 0 5 mm" shaft="1 0 0" flat="0 0 1" coupling="300 N/m" sharp=")" +
                              sharp + "\"/>"),
        folder.path() / "cut.xml");
    if (!s) return;
    strands = s->scene().find_as<StrandSprings>("strands");
    knife = s->scene().find_as<Instrument>("knife");
    strands->add_strand(wall(Vec3(0, 0, 0)), wall(Vec3(0, 0, 0.01)));
  }
  void move(double x, bool button = false) {
    HandState hand;
    hand.present = true;
    hand.device = knife->home_pose();
    hand.device.p.x() = x;
    hand.button1 = button;
    s->set_hand(1, hand);
    s->step();
  }
};

// The hand moves 0.1 mm a step. Until the coupling carries cut_force the blade stands; then the hand feels cut_force
// exactly, and the strand parts when the blade's travel has reached cut_length.
TEST(StrandSprings, ResistsWithCutForceAndPartsAfterCutLength) {
  CutBed t("stiffness=\"30 N/m\" slack=\"0.9\" cut_force=\"0.045 N\" cut_length=\"0.3 mm\" reach=\"0.5 mm\"");
  ASSERT_TRUE(t.strands && t.knife);
  double travel = 0;
  int severed_at = -1;
  test::Figure figure("cut", "A blade drawn over a strand: 45 mN at most, until it parts",
                      "displacement of the hand, mm", "force on the hand, mN");
  for (int n = 1; n <= 10; ++n) {
    const double before = t.knife->pose().p.x(), damage = 1 - t.strands->integrity(0);
    t.move(0.00045 - n * 1e-4);
    figure.run("run", n * 0.1, t.knife->hand_force()[0] * 1e3);
    figure.law("law", n * 0.1, severed_at >= 0 ? 0 : std::min(n * 1e-4 * 300, 0.045) * 1e3);
    if (severed_at >= 0) {
      EXPECT_LT(t.knife->hand_force().norm(), 1e-12) << "a severed strand resists, step " << n;
      EXPECT_EQ(t.strands->strands_left(), 0);
      continue;
    }
    const double force = n * 1e-4 * 300 < 0.045 ? n * 1e-4 * 300 : 0.045;
    EXPECT_NEAR(t.knife->hand_force()[0], force, 1e-9) << "step " << n;
    EXPECT_LT(t.knife->hand_force().tail<5>().norm(), 1e-12);
    travel += before - t.knife->pose().p.x();
    if (travel >= 0.0003 - 1e-12) {
      severed_at = n;
      ASSERT_EQ(t.s->events().size(), 1u);
      EXPECT_EQ(t.s->events()[0].kind, "strand_cut");
      EXPECT_EQ(t.s->events()[0].hand, 1) << "whose edge did it";
      EXPECT_EQ(t.strands->strands_left(), 0);
    } else {
      EXPECT_EQ(t.strands->strands_left(), 1);
      EXPECT_NEAR(t.strands->integrity(0), 1 - travel / 0.0003, 1e-9) << "step " << n;
      EXPECT_NEAR(t.strands->strand(0).tension, 30 * (1 - damage) * 0.1 * 0.01, 1e-9)
          << "stiffness falls with the wear";
      EXPECT_TRUE(t.s->events().empty());
    }
  }
  EXPECT_EQ(severed_at, 5);
}

// A worn strand tears at a lower tension. Under a blade it would be cut.
TEST(StrandSprings, LoadIsTheShareOfWhatTearsAStrandAsItIs) {
  CutBed t(
      "stiffness=\"30 N/m\" slack=\"0.9\" strength=\"0.05 N\" cut_force=\"0.045 N\" cut_length=\"5 mm\" "
      "reach=\"0.5 mm\"");
  ASSERT_TRUE(t.strands && t.knife);
  const auto expect_load = [&](double share) {
    EXPECT_NEAR(t.s->channel("strands.load"), share, 1e-9) << "integrity " << t.strands->integrity(0);
  };
  for (int n = 1; n <= 3; ++n) t.move(0.00045 - n * 1e-4);
  expect_load(0);
  for (int n = 0; n < 3; ++n) t.move(0.002);  // beyond reach
  ASSERT_GT(t.strands->integrity(0), 0.05);
  ASSERT_LT(t.strands->integrity(0), 0.95);
  expect_load(t.s->channel("strands.tension") / (0.05 * t.strands->integrity(0)));
  expect_load(0.03 / 0.05);  // its stiffness has fallen as its strength
}

// The servo knows of the blade already, but the pull has torn the strand.
TEST(StrandSprings, ABladeThatIsOnItsPathCutsNothingYet) {
  CutBed t("stiffness=\"30 N/m\" slack=\"0.9\" strength=\"0.02 N\" reach=\"0.2 mm\"");
  ASSERT_TRUE(t.strands && t.knife);
  t.s->set_collision_horizon(0.1);
  t.move(0.00035);
  ASSERT_EQ(t.s->problem().rows, 2) << "strand and blade";
  EXPECT_NEAR(t.s->problem().delta_free[1], -0.00015, 1e-9) << "0.35 mm off, 0.2 mm of reach";
  ASSERT_EQ(t.s->events().size(), 1u);
  EXPECT_EQ(t.s->events()[0].kind, "strand_torn");
  EXPECT_EQ(t.s->events()[0].hand, -1) << "nobody's edge";
}

TEST(StrandSprings, BluntOrWithoutTheButtonDoesNotCut) {
  for (const char* sharp : {"never", "button"}) {
    CutBed t("cut_force=\"0.045 N\" cut_length=\"0.3 mm\"", sharp);
    ASSERT_TRUE(t.strands && t.knife);
    for (int n = 1; n <= 10; ++n) t.move(0.00045 - n * 1e-4);
    EXPECT_EQ(t.strands->integrity(0), 1) << sharp;
    EXPECT_EQ(t.strands->strands_left(), 1);
  }
  CutBed t("cut_force=\"0.045 N\" cut_length=\"0.3 mm\"", "button");
  ASSERT_TRUE(t.strands && t.knife);
  for (int n = 1; n <= 10; ++n) t.move(0.00045 - n * 1e-4, true);
  EXPECT_EQ(t.strands->strands_left(), 0);
}

TEST(StrandSprings, WithoutResistanceTheBladeGoesThroughFreely) {
  CutBed t("cut_force=\"0 N\" cut_length=\"0.35 mm\"");
  ASSERT_TRUE(t.strands && t.knife);
  for (int n = 1; n <= 4; ++n) {
    EXPECT_EQ(t.strands->strands_left(), 1) << n;
    t.move(0.00045 - n * 1e-4);
    EXPECT_LT(t.knife->hand_force().norm(), 1e-12);
  }
  EXPECT_EQ(t.strands->strands_left(), 0);
}

TEST(StrandSprings, ResetMakesThemWholeAgain) {
  CutBed t("cut_force=\"0.045 N\" cut_length=\"0.3 mm\"");
  ASSERT_TRUE(t.strands && t.knife);
  for (int n = 1; n <= 10; ++n) t.move(0.00045 - n * 1e-4);
  ASSERT_EQ(t.strands->strands_left(), 0);
  t.s->reset();
  EXPECT_EQ(t.strands->strands_left(), 1);
  EXPECT_EQ(t.strands->integrity(0), 1);
}

TEST(StrandSprings, TearsBeyondItsStrength) {
  for (const double strength : {0.029, 0.031}) {  // tension at rest 30 N/m * 1 mm = 0.03 N
    Bed t(fmt::format("stiffness=\"30 N/m\" slack=\"0.9\" strength=\"{} N\"", strength), "<obstacle id=\"wall\"/>");
    ASSERT_TRUE(t.strands);
    t.strands->add_strand(t.wall(Vec3(0.1, 0, 0)), t.wall(Vec3(0.1, 0, 0.01)));
    t.s->step();
    EXPECT_EQ(t.strands->strands_left(), strength > 0.03 ? 1 : 0);
    ASSERT_EQ(t.s->events().size(), strength > 0.03 ? 0u : 1u);
    if (strength < 0.03) {
      EXPECT_EQ(t.s->events()[0].kind, "strand_torn");
    }
  }
}

// Pulled tight and touched by a blade it is cut; out of the blade's reach the same pull tears it.
TEST(StrandSprings, ATautStrandUnderABladeIsCut) {
  for (const char* reach : {"0.5 mm", "0.3 mm"}) {
    CutBed t(fmt::format("stiffness=\"30 N/m\" slack=\"0.9\" strength=\"0.029 N\" reach=\"{}\"", reach));
    ASSERT_TRUE(t.strands && t.knife);
    t.move(0.00044);
    ASSERT_EQ(t.s->events().size(), 1u);
    EXPECT_EQ(t.s->events()[0].kind, std::string_view(reach) == "0.5 mm" ? "strand_cut" : "strand_torn");
  }
}

}  // namespace
}  // namespace insula
