// SPDX-License-Identifier: GPL-3.0-or-later
// One piece of membrane between two strands on fixed points, and a ball that a hand presses into it: against the closed
// form of the discretised law; tearing, cutting and retracting; the side from which a tool came.
#include "plugins/arachnoid_membrane/arachnoid_membrane.h"

#include <gtest/gtest.h>

#include <fmt/format.h>

#include <cmath>

#include "core/testing/block_mesh.h"
#include "core/testing/example.h"
#include "core/testing/held.h"

namespace insula {
namespace {

constexpr double radius = 0.0005, coupling = 300;
constexpr double width = 0.004, height = 0.003;  // of the piece, in the plane x = 0

/// A scene whose hand holds a ball with a cutting edge along y (or a blunt one).
struct Bed {
  test::SceneFolder folder;
  std::unique_ptr<Simulation> s;
  ArachnoidMembrane* membrane = nullptr;
  StrandSprings* strands = nullptr;
  Instrument* tool = nullptr;
  double event_force = -1;
  int torn = 0, cut = 0;

  explicit Bed(const std::string& attributes, bool sharp = false, const std::string& bodies = "") {
    folder.write("meshes/tool/tool.urdf", test::test_tool_urdf(radius));
    folder.write("meshes/tool/tool.json", test::test_tool_json(0.0004, 0));
    s = test::load_text(fmt::format(R"(<scene time_step="10 ms"><solver tolerance="1e-15 m" max_sweeps="10000"/>
  <obstacle id="wall"/>{}
  <arachnoid_membrane id="membrane" strands="strands" {}/>
  <strand_springs id="strands" slack="1.5" cut_force="0 N"/>
  <dissector id="tool" model="meshes/tool/tool.urdf" hand="right" home="2 2 1 mm" shaft="1 0.02 0.01" flat="0 0 1"
    coupling="300 N/m" angular_coupling="10 N m/rad" sharp="{}"/></scene>)",
                                    bodies, attributes, sharp ? "always" : "never"),
                        folder.path() / "membrane.xml");
    if (!s) return;
    membrane = s->scene().find_as<ArachnoidMembrane>("membrane");
    strands = s->scene().find_as<StrandSprings>("strands");
    tool = s->scene().find_as<Instrument>("tool");
  }
  MaterialPoint wall(const Vec3& at) const {
    MaterialPoint p;
    p.body = s->scene().find_as<Body>("wall");
    p.local = at;
    return p;
  }
  void strand(double y) { strands->add_strand(wall(Vec3(0, y, 0)), wall(Vec3(0, y, height))); }
  void piece() {
    strand(0);
    strand(width);
    membrane->weave();
  }
  /// Brings the hand there in one step.
  void hand(const Vec3& at) {
    HandState hand;
    hand.present = true;
    hand.device = tool->home_pose();
    hand.device.p = at;
    s->set_hand(1, hand);
    s->step();
    for (const Event& e : s->events()) {
      torn += e.kind == "membrane_torn";
      cut += e.kind == "membrane_cut";
      if (e.kind.starts_with("membrane")) event_force = e.value;
    }
  }
};

// The hand moves the free ball by x below the piece. Its coupling and the tent are two springs in series.
TEST(ArachnoidMembrane, ATentPushesBackInProportionToItsDepth) {
  for (const double from : {1.0, -1.0}) {
    Bed t("span=\"5 mm\" stiffness=\"15 N/m\" strength=\"1 N\" tear_depth=\"3 mm\"");
    ASSERT_TRUE(t.membrane);
    t.piece();
    ASSERT_EQ(t.membrane->count(), 1);
    // To its side, around the piece.
    t.hand(Vec3(0.003, -0.02, 0.001));
    t.hand(Vec3(from * 0.003, -0.02, 0.001));
    t.hand(Vec3(from * 0.003, 0.0013, 0.0011));
    for (int n = 0; n <= 34; ++n) {
      const double x = radius + 0.0005 - n * 1e-4;  // of the hand; the ball touches at x = radius
      t.hand(Vec3(from * x, 0.0013, 0.0011));
      const double pressed = std::max(0.0, radius - x), force = pressed / (1 / coupling + 1 / 15.0);
      ASSERT_EQ(t.torn, 0);
      EXPECT_TRUE(test::held("force of a tent = stiffness x depth", std::abs(t.membrane->force(0) - force), 0.05, 1e-6))
          << "step " << n;
      EXPECT_NEAR(t.tool->hand_force()[0], from * force, 1e-6 * 0.05) << "step " << n;
      EXPECT_NEAR(from * t.tool->pose().p.x(), x + force / coupling, 1e-9) << "step " << n;
    }
    EXPECT_GT(t.membrane->force(0), 0.03);
  }
}

/// An apex of a tetrahedron on three fixed nodes, at this place.
constexpr double a = 0.004;
std::string tetrahedron(const test::SceneFolder& folder, const std::string& id, const Vec3& apex) {
  folder.write("meshes/" + id + ".msh", test::gmsh_text(test::single_tet(a, apex - Vec3(0, 0, a))));
  return fmt::format(R"(<soft_body id="{0}" mesh="meshes/{0}.msh" mesh_unit="m">
    <corotational_fem young="3000 Pa" poisson="0" density="1000 kg/m3" rayleigh_mass="0 1/s" rayleigh_stiffness="0 s"/>
    <fixed region="beyond" centre="0 0 {1} m" normal="0 0 -1"/></soft_body>)",
                     id, apex.z() - 0.1 * a);
}

// Corners yield as their own springs do: with the weights w the piece moves by sum w^2 F / k.
TEST(ArachnoidMembrane, TheFourEndsCarryTheForceInTheirShares) {
  Bed t("span=\"5 mm\"", false, "");
  const std::array<Vec3, 4> ends = {Vec3(0, 0, 0), Vec3(0, 0, height), Vec3(0, width, 0), Vec3(0, width, height)};
  std::string bodies;
  for (int k = 0; k < 4; ++k) bodies += tetrahedron(t.folder, fmt::format("end{}", k), ends[std::size_t(k)]);
  t.s = test::load_text(fmt::format(R"(<scene time_step="10 ms"><solver tolerance="1e-15 m" max_sweeps="10000"/>{}
  <strand_springs id="strands" slack="1.5"/>
  <arachnoid_membrane id="membrane" strands="strands" span="5 mm" stiffness="2 N/m" strength="1 N" tear_depth="3 mm"/>
  <dissector id="tool" model="meshes/tool/tool.urdf" hand="right" home="2 2 1 mm" shaft="1 0 0" flat="0 0 1"
    coupling="300 N/m" angular_coupling="10 N m/rad" sharp="never"/></scene>)",
                                    bodies),
                        t.folder.path() / "shares.xml");
  ASSERT_TRUE(t.s);
  t.membrane = t.s->scene().find_as<ArachnoidMembrane>("membrane");
  t.strands = t.s->scene().find_as<StrandSprings>("strands");
  t.tool = t.s->scene().find_as<Instrument>("tool");
  const auto apex = [&](int k) {
    MaterialPoint p;
    p.body = t.s->scene().find_as<Body>(fmt::format("end{}", k));
    p.count = 1;
    p.node[0] = 3;
    p.weight[0] = 1;
    return p;
  };
  t.strands->add_strand(apex(0), apex(1));
  t.strands->add_strand(apex(2), apex(3));
  t.membrane->weave();
  ASSERT_EQ(t.membrane->count(), 1);
  for (int n = 0; n < 600; ++n) t.hand(Vec3(std::max(0.0, 0.001 - n * 1e-4), 0.0013, 0.0011));
  const double force = t.membrane->force(0);
  ASSERT_GT(force, 5e-4);
  std::array<double, 4> way{};
  for (int k = 0; k < 4; ++k) way[std::size_t(k)] = -t.s->scene().find_as<SoftBody>(fmt::format("end{}", k))->q()[9];
  double sum = 0;
  for (const double w : way) sum += w;
  const double s_ = 0.0013 / width, t_ = 0.0011 / height;
  const std::array<double, 4> share = BilinearPatch::weights(s_, t_);
  // All four springs are alike, and the corners move by little, so the shares hold to the turning of the patch.
  for (std::size_t k = 0; k < 4; ++k) EXPECT_NEAR(way[k] / sum, share[k], 0.02) << k;
  EXPECT_NEAR(t.tool->hand_force()[0], force, 1e-3 * force);
}

TEST(ArachnoidMembrane, TearsAtItsStrengthAndNeverPushesHarder) {
  Bed t("span=\"5 mm\" stiffness=\"15 N/m\" strength=\"0.02 N\"");
  ASSERT_TRUE(t.membrane);
  t.piece();
  double most = 0;
  for (int n = 0; n <= 30 && t.torn == 0; ++n) {
    t.hand(Vec3(radius + 0.0005 - n * 1e-4, 0.0013, 0.0011));
    most = std::max(most, t.membrane->force(0));
    // 0.02 N at a tent of 0.02 / 15 and a hand that is 0.02 / 300 m ahead: in step 20.
    EXPECT_EQ(t.torn, n * 1e-4 - 0.0005 >= 0.02 / 15 + 0.02 / 300 ? 1 : 0) << n;
  }
  EXPECT_EQ(t.torn, 1);
  EXPECT_NEAR(most, 0.02, 1e-12);
  EXPECT_NEAR(t.event_force, 0.02, 1e-12);
  EXPECT_EQ(t.membrane->pieces_left(), 0);
  t.hand(Vec3(-0.001, 0.0013, 0.0011));
  EXPECT_LT(t.tool->hand_force().norm(), 1e-12) << "a torn piece pushes";
  EXPECT_EQ(t.strands->strands_left(), 2) << "strands tear on their own";
  t.s->reset();
  EXPECT_EQ(t.membrane->pieces_left(), 1);
  EXPECT_EQ(t.membrane->integrity(0), 1);
}

TEST(ArachnoidMembrane, TearsBeyondItsDepth) {
  Bed t("span=\"5 mm\" stiffness=\"15 N/m\" strength=\"1 N\" tear_depth=\"1 mm\"");
  ASSERT_TRUE(t.membrane);
  t.piece();
  int n = 0;
  for (; n <= 30 && t.torn == 0; ++n) t.hand(Vec3(radius - n * 1e-4, 0.0013, 0.0011));
  // depth = x 300 / 315 > 1 mm for the first time at x = 1.1 mm.
  EXPECT_EQ(n - 1, 11);
}

TEST(ArachnoidMembrane, ACuttingEdgeWearsItAsItTravels) {
  for (const bool sharp : {false, true}) {
    Bed t("span=\"5 mm\" stiffness=\"1 N/m\" strength=\"1 N\" cut_length=\"0.75 mm\" reach=\"1 mm\"", sharp);
    ASSERT_TRUE(t.membrane);
    t.piece();
    t.hand(Vec3(radius - 1e-5, 0.001, 0.0011));
    double last = 0;
    for (int n = 1; n <= 10; ++n) {
      t.hand(Vec3(radius - 1e-5, 0.001, 0.0011 + n * 1e-4));
      const double travel = n * 1e-4;
      if (!sharp) {
        EXPECT_EQ(t.membrane->integrity(0), 1) << n;
      } else if (n < 8) {
        EXPECT_NEAR(t.membrane->integrity(0), 1 - travel / 0.00075, 1e-6) << n;
        last = t.membrane->integrity(0);
      }
    }
    EXPECT_EQ(t.cut, sharp ? 1 : 0);
    EXPECT_EQ(t.torn, 0);
    if (sharp) {
      EXPECT_NEAR(last, 1 - 0.7 / 0.75, 1e-6);
    }
  }
}

TEST(ArachnoidMembrane, StiffnessFallsWithTheWear) {
  Bed t("span=\"5 mm\" stiffness=\"15 N/m\" strength=\"1 N\" cut_length=\"2 mm\" reach=\"1.5 mm\"", true);
  ASSERT_TRUE(t.membrane);
  t.piece();
  t.hand(Vec3(0.001, 0.001, 0.0011));
  for (int n = 1; n <= 10; ++n) t.hand(Vec3(0.001, 0.001, 0.0011 + n * 1e-4));
  const double whole = t.membrane->integrity(0);
  EXPECT_NEAR(whole, 0.5, 1e-6);
  t.hand(Vec3(radius + 1e-4, 0.001, 0.0021));
  t.hand(Vec3(radius - 1e-3, 0.001, 0.0021));
  // Pressing straight in is no travel along the piece.
  EXPECT_NEAR(t.membrane->force(0), 1e-3 / (1 / coupling + 1 / (15 * whole)), 1e-6 * 0.01);
}

TEST(ArachnoidMembrane, GoesWithItsStrands) {
  Bed t("span=\"5 mm\" stiffness=\"15 N/m\" strength=\"1 N\" reach=\"0.01 mm\"", true);
  ASSERT_TRUE(t.membrane);
  t.piece();
  const auto push = [&](double y) {
    t.hand(Vec3(0.004, y, 0.0011));
    t.hand(Vec3(radius - 0.0005, y, 0.0011));
    const double force = t.membrane->force(0);
    t.hand(Vec3(0.004, y, 0.0011));
    return force;
  };
  EXPECT_GT(push(0.25 * width), 0.005);
  EXPECT_GT(push(0.75 * width), 0.005);
  // An edge that is drawn through a strand parts it.
  const auto part = [&](double y) {
    for (int n = 0; n < 60; ++n) t.hand(Vec3(0.003 - n * 1e-4, y, 0.0015));
    t.hand(Vec3(0.02, y, 0.0015));
  };
  part(0);
  ASSERT_EQ(t.strands->strands_left(), 1);
  ASSERT_EQ(t.membrane->pieces_left(), 1);
  EXPECT_EQ(push(0.25 * width), 0) << "the half beside the parted strand is gone";
  EXPECT_GT(push(0.75 * width), 0.005);
  part(width);
  ASSERT_EQ(t.strands->strands_left(), 0);
  EXPECT_EQ(t.membrane->pieces_left(), 0);
  EXPECT_EQ(push(0.75 * width), 0);
  EXPECT_EQ(t.torn + t.cut, 0) << "it retracts without a word";
}

// Around the edge of a piece there is a way to its other side; and what comes from there is not thrown back.
TEST(ArachnoidMembrane, PushesToTheSideThatTheToolCameFrom) {
  Bed t("span=\"5 mm\" stiffness=\"15 N/m\" strength=\"1 N\"");
  ASSERT_TRUE(t.membrane);
  t.piece();
  t.hand(Vec3(0.001, 0.001, 0.001));
  t.hand(Vec3(0.001, -0.002, 0.001));
  t.hand(Vec3(0, -0.002, 0.001));
  t.hand(Vec3(0, 0.001, 0.001));
  EXPECT_EQ(t.membrane->force(0), 0) << "it came in beside the piece";
  t.hand(Vec3(-0.001, 0.001, 0.001));
  EXPECT_EQ(t.membrane->force(0), 0);
  t.hand(Vec3(0, 0.001, 0.001));
  EXPECT_NEAR(t.membrane->force(0), radius / (1 / coupling + 1 / 15.0), 1e-8);
  EXPECT_LT(t.tool->hand_force()[0], 0);
}

TEST(ArachnoidMembrane, RigidMotionOfAllGivesNoForce) {
  const auto example = std::filesystem::path(INSULA_SOURCE_DIR) / "plugins/arachnoid_membrane/example.xml";
  const auto s = test::load(example);
  ASSERT_TRUE(s);
  const auto* membrane = s->scene().find_as<ArachnoidMembrane>("membrane");
  ASSERT_GT(membrane->count(), 5);
  const Quat turn(Eigen::AngleAxisd(0.7, Vec3(1, 2, 3).normalized()));
  const Vec3 shift(0.1, -0.05, 0.02);
  for (const char* id : {"lower", "upper"}) {
    auto* body = s->scene().find_as<SoftBody>(id);
    for (int i = 0; i < body->nodes(); ++i)
      body->q().segment<3>(3 * i) = turn * Vec3(body->q().segment<3>(3 * i)) + shift;
  }
  auto* knife = s->scene().find_as<Instrument>("knife");
  // Before and after: no energy, with the knife beside the membrane.
  EXPECT_EQ(membrane->law().energy, 0);
  knife->place({turn * knife->pose().p + shift, turn * knife->pose().q});
  EXPECT_EQ(membrane->law().energy, 0);
}

TEST(ArachnoidMembrane, NeighboursHaveNoThirdStrandBetweenThem) {
  std::vector<StrandState> grid;
  for (int i = 0; i < 3; ++i)
    for (int j = 0; j < 3; ++j) {
      StrandState s;
      s.a = Vec3(0.001 * i, 0.00101 * j, 0);
      s.b = s.a + Vec3(0, 0, 0.003);
      // Ends may be the wrong way round.
      if ((i + j) % 2 == 1) std::swap(s.a, s.b);
      grid.push_back(s);
    }
  const auto far = [](const StrandPair& p) {
    return std::abs(p.first / 3 - p.second / 3) + std::abs(p.first % 3 - p.second % 3);
  };
  int sides = 0;
  for (const StrandPair& p : neighbouring_strands(grid, 0.004)) {
    EXPECT_LT(p.first, p.second);
    EXPECT_LE(far(p), 2);
    sides += far(p) == 1;
    EXPECT_EQ(p.crossed, far(p) == 1);
  }
  EXPECT_EQ(sides, 12);
  grid[4].integrity = -1;
  for (const StrandPair& p : neighbouring_strands(grid, 0.004)) EXPECT_TRUE(p.first != 4 && p.second != 4);
  EXPECT_TRUE(neighbouring_strands(grid, 0.0009).empty());
}

TEST(ArachnoidMembrane, FootsOfATwistedPatchAreItsNearestPoints) {
  const BilinearPatch patch{
      {Vec3(0, 0, 0), Vec3(0, 0.003, 0.0004), Vec3(0.004, 0, 0.0007), Vec3(0.0035, 0.0032, -0.0004)}};
  for (const double s : {0.1, 0.45, 0.9})
    for (const double t : {0.2, 0.5, 0.95})
      for (const double z : {-0.0012, 0.0003, 0.0015}) {
        BilinearPatch::Foot at, found;
        ASSERT_TRUE(patch.foot(patch.at(s, t), at));
        ASSERT_TRUE(patch.foot(patch.at(s, t) + z * at.normal, found));
        EXPECT_NEAR(found.s, s, 1e-10);
        EXPECT_NEAR(found.t, t, 1e-10);
        EXPECT_NEAR(found.height, z, 1e-13);
      }
}

TEST(ArachnoidMembrane, BoundsOfAPatchHoldForEachFoot) {
  const BilinearPatch flat{{Vec3(0, 0, 0), Vec3(0, 0.003, 0), Vec3(0.004, 0, 0), Vec3(0.004, 0.003, 0)}};
  const BilinearPatch twisted{
      {Vec3(0, 0, 0), Vec3(0, 0.003, 0.0004), Vec3(0.004, 0, 0.0007), Vec3(0.0035, 0.0032, -0.0004)}};
  const BilinearPatch folded{{Vec3(0, 0, 0), Vec3(0, 0.003, 0.004), Vec3(0.003, 0, 0.004), Vec3(0.003, 0.003, -0.004)}};
  double tightest = 1;
  for (const BilinearPatch& patch : {flat, twisted, folded}) {
    const BilinearPatch::Bounds bounds(patch);
    for (const double s : {0.0, 0.3, 0.7, 1.0})
      for (const double t : {0.0, 0.2, 0.8, 1.0})
        for (const double z : {-0.003, -0.0006, 0.0, 0.0003, 0.002}) {
          const Vec3 p = patch.at(s, t) + z * patch.normal(s, t);
          EXPECT_LE(bounds.least_height(p, 1), z + 1e-15);
          EXPECT_LE(bounds.least_height(p, -1), -z + 1e-15);
          EXPECT_LE(bounds.least_distance(p), std::abs(z) + 1e-15);
          for (const Vec3& aside : {Vec3(0, 0, 0), Vec3(0.002, 0, 0), Vec3(0, -0.001, 0.0005)})
            EXPECT_TRUE(bounds.may_have_foot(p + aside, aside.norm() + 1e-15, std::abs(z) + 1e-15));
          if (std::isfinite(bounds.least_height(p, 1))) tightest = std::min(tightest, z - bounds.least_height(p, 1));
        }
  }
  EXPECT_NEAR(tightest, 0, 1e-15);  // of the flat one
  // A flat patch leaves nothing in doubt.
  const BilinearPatch::Bounds exact(flat);
  for (const auto& [x, inside] : {std::pair{0.00401, false}, {0.00399, true}, {-0.00001, false}})
    EXPECT_EQ(exact.may_have_foot(Vec3(x, 0.0015, 0.001), 0, 0.004), inside) << x;
  EXPECT_FALSE(exact.may_have_foot(Vec3(0.002, 0.0015, 0.00401), 0, 0.004)) << "too high";
  EXPECT_FALSE(std::isfinite(BilinearPatch::Bounds(folded).least_height(Vec3(0.0015, 0.0015, 1), 1)));
}

}  // namespace
}  // namespace insula
