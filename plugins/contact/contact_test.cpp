// SPDX-License-Identifier: GPL-3.0-or-later
// Contact in whole steps: closed forms of the discretised law, no tunnelling, balance, determinism, no allocation.
#include "core/testing/held.h"
#include "plugins/contact/contact_for_test.h"
#include "tests/figures/figure.h"

namespace insula {
namespace {

using namespace test;

// The coupling stands in for a weight on a slope: pulled down by k dz and along by k dx, tan(angle) = dx / dz.
TEST(Contact, ABlockOnASlopeSticksAndSlipsAtTheFrictionAngle) {
  constexpr double mu = 0.35, dz = 1e-3;
  test::Figure figure("friction", "A block pulled along what it presses on: sticks, then slips at mu N",
                      "pull over mu N", "friction, N");
  for (const double pull : {0.0, 1.0, 1.5}) figure.law("law", pull, std::min(pull, 1.0) * mu * 400 * dz);
  for (const double angle_factor : {0.5, 1 - 1e-5, 1 + 1e-5, 1.5}) {
    for (const double heading : {0.0, 0.7, 2.1}) {
      Bench b(feet_urdf(5e-3, radius), ground(), upright, fmt::format(R"(friction="{}")", mu));
      ASSERT_TRUE(b.tool);
      const Pose home = b.tool->home_pose();
      Pose down = home;
      down.p.z() = radius - dz;
      for (int i = 0; i < 5; ++i) b.move_to(down);
      const Vec3 rest = b.tool->pose().p;
      EXPECT_NEAR(rest.z(), radius, 1e-9);
      Pose along = down;
      along.p.x() = rest.x() + mu * angle_factor * dz * std::cos(heading);
      along.p.y() = rest.y() + mu * angle_factor * dz * std::sin(heading);
      for (int i = 0; i < 3; ++i) b.move_to(along);
      const Vec3 moved = b.tool->pose().p - rest;
      double normal = 0;
      Vec3 friction = Vec3::Zero();
      for (const ContactPoint& c : b.s->report().contacts) {
        normal += c.normal_force;
        friction += c.tangent_force;
      }
      EXPECT_NEAR(normal, 400 * dz, 1e-7);
      figure.run("run", angle_factor, friction.norm());
      if (angle_factor < 1) {
        EXPECT_LT(moved.norm(), 1e-9) << angle_factor;
        EXPECT_NEAR(friction.norm(), 400 * mu * angle_factor * dz, 1e-7);
      } else {
        // Slips until the pull is mu times the weight again.
        EXPECT_NEAR(moved.head<2>().norm(), mu * (angle_factor - 1) * dz, 1e-9) << angle_factor;
        EXPECT_NEAR(friction.norm(), mu * normal, 1e-6);
        EXPECT_LT(friction.dot(moved), 0);
      }
    }
  }
}

TEST(Contact, NeverPenetratesAndOnlyPushes) {
  Bench b(feet_urdf(5e-3, radius), ground(), upright, R"(friction="0.3")");
  ASSERT_TRUE(b.tool);
  shapes::Random r(4);
  const Pose home = b.tool->home_pose();
  int touched = 0;
  for (int i = 0; i < 400; ++i) {
    Pose at = home;
    at.p += Vec3(0.01 * std::sin(0.05 * i), 0.008 * std::sin(0.031 * i), 0.004 * std::sin(0.11 * i) - 0.003);
    at.q = from_rotation_vector(Vec3(0.05 * std::sin(0.07 * i), 0.05 * std::cos(0.05 * i), 0.1 * std::sin(0.02 * i))) *
           at.q;
    b.move_to(at);
    for (const ConvexPiece& p : b.tool->tool().pieces)
      EXPECT_GT(b.tool->pose().apply(p.points[0]).z() - p.radius, -1e-6) << i;
    for (const ContactPoint& c : b.s->report().contacts) {
      EXPECT_GE(c.normal_force, 0);
      EXPECT_LE(c.tangent_force.norm(), 0.3 * c.normal_force + 1e-9);
      touched += c.normal_force > 0;
    }
  }
  EXPECT_GT(touched, 100);
}

TEST(Contact, SignoriniHoldsRowByRow) {
  Bench b(feet_urdf(5e-3, radius), ground(), upright, R"(friction="0")");
  ASSERT_TRUE(b.tool);
  Pose at = b.tool->home_pose();
  at.q = from_rotation_vector(Vec3(0.02, 0.03, 0)) * at.q;
  at.p.z() = 0.0005;
  for (int i = 0; i < 20; ++i) {
    b.move_to(at);
    const ConstraintProblem& p = b.s->problem();
    ASSERT_GT(p.rows, 0);
    for (int row = 0; row < p.rows; ++row) {
      double delta = p.delta_free[std::size_t(row)];
      for (int k = 0; k < p.rows; ++k) delta += p.w_at(row, k) * p.lambda[std::size_t(k)];
      EXPECT_GE(delta, -1e-12);
      EXPECT_GE(p.lambda[std::size_t(row)], 0);
      EXPECT_TRUE(
          test::held("delta lambda = 0 in every row, J", std::abs(delta * p.lambda[std::size_t(row)]), 1, 1e-12));
    }
  }
}

TEST(Contact, AFastToolNeverEndsInsideAPlate) {
  const TriMesh plate = shapes::box(Vec3(-0.2, -0.2, -0.002), Vec3(0.2, 0.2, 0), 50);
  for (const bool long_tool : {false, true}) {
    Bench b(long_tool ? rod_urdf(0.03, radius) : test::test_tool_urdf(radius), plate, upright, R"(friction="0.2")");
    ASSERT_TRUE(b.tool);
    shapes::Random r(11);
    const double step = 0.5 * b.s->h();  // 0.5 m/s
    int hits = 0;
    for (int k = 0; k < 200; ++k) {
      b.s->reset();
      const Vec3 target(r.between(-0.02, 0.02), r.between(-0.02, 0.02), -0.02);
      Vec3 d;
      do d = r.direction();
      while (d.z() > -0.3);
      Pose at;
      at.q = from_rotation_vector(r.in_box(0.4));
      at.p = target + d * ((0.012 + r.between(0, step)) - target.z()) / d.z();
      b.tool->place(at);
      b.hand(at);
      for (int i = 0; i < 8; ++i) {
        at.p += step * d;
        b.move_to(at);
        // A long tool turns about its contacts within the step, which the rows take as linear.
        double least = 1;
        for (const Vec3& p : b.tool->tool().pieces[0].points)
          least = std::min(least, b.tool->pose().apply(p).z() - radius);
        EXPECT_GT(least, long_tool ? -1e-5 : -1e-6) << "pose " << k << " step " << i;
        for (const ContactPoint& c : b.s->report().contacts) hits += c.normal_force > 0;
      }
    }
    EXPECT_GT(hits, 500);
  }
}

/// Nodes and tool poses of all bodies at the start of a step, body by body.
struct StartOfStep {
  std::vector<VecX> q;
  std::vector<Pose> pose;
  explicit StartOfStep(const Simulation& s) {
    for (const Body* b : s.bodies()) {
      const auto* soft = dynamic_cast<const SoftBody*>(b);
      const auto* tool = dynamic_cast<const Instrument*>(b);
      q.push_back(soft ? soft->q() : VecX());
      pose.push_back(tool ? tool->pose() : Pose());
    }
  }
};

/// Sum of the forces and moments that the three rows of a contact apply to all bodies.
struct Balance {
  Vec3 force = Vec3::Zero(), moment = Vec3::Zero();
  double size = 0;  ///< sum of the sizes of all forces, N
};

void add_entry(Balance& to, const StartOfStep& start, std::size_t body, int at, const Vec3& f) {
  const VecX& q = start.q[body];
  if (q.size() > 0) to.moment += Vec3(q.segment<3>(3 * at)).cross(f);
  else if (at == 0) to.moment += start.pose[body].p.cross(f);
  else to.moment += f;
  if (q.size() > 0 || at == 0) {
    to.force += f;
    to.size += f.norm();
  }
}

Balance balance_of(const Simulation& s, const StartOfStep& start, int row) {
  const ConstraintProblem& p = s.problem();
  Balance out;
  for (std::size_t b = 0; b < s.bodies().size(); ++b) {
    const BodyRows& rows = s.bodies()[b]->rows;
    for (int r = 0; r < rows.count(); ++r) {
      if (rows.row[std::size_t(r)] < row || rows.row[std::size_t(r)] > row + 2) continue;
      for (int e = rows.start[std::size_t(r)]; e < rows.start[std::size_t(r) + 1]; ++e)
        add_entry(out, start, b, rows.block[std::size_t(e)],
                  p.lambda[std::size_t(rows.row[std::size_t(r)])] * rows.coeff[std::size_t(e)]);
    }
  }
  return out;
}

/// Vector between the points on which the two sides of a contact act. At the time of the contact both act at one point.
/// At the start of the step, the motion until then separates them. Tissue points are also separated by the gap, but the
/// normal force along it has no moment.
Vec3 arm_between_sides(const Contact::Pair& pair, const Proximity& x, const StartOfStep& start) {
  if (!pair.tool_a) return x.gap * x.normal;
  if (pair.tool_b) return Vec3::Zero();
  return start.pose[std::size_t(pair.tool_a->index)].apply(x.local) - pair.b->collision().point(x.triangle, x.bary);
}

TEST(Contact, ForcesOnBothSidesAddUpToNothing) {
  SceneFolder folder;
  auto s = soft_bench(folder, R"(<contact between="left right pad top" friction="0.3"/>)");
  ASSERT_TRUE(s);
  const Contact* contact = s->scene().all<Contact>().front();
  int tool_rows = 0, tissue_rows = 0, exact = 0;
  for (int i = 0; i < 90; ++i) {
    press(*s, i);
    const StartOfStep start(*s);
    s->step();
    const ConstraintProblem& p = s->problem();
    for (const Contact::Pair& pair : contact->pairs())
      for (std::size_t k = 0; k < pair.rows.size(); ++k) {
        const int row = pair.rows[k];
        if (p.lambda[std::size_t(row)] <= 0) continue;
        const Balance sum = balance_of(*s, start, row);
        EXPECT_TRUE(test::held("action = reaction of contacts", sum.force.norm(), sum.size, 1e-12));
        const Proximity& x = pair.contacts[k];
        const Vec3 arm = arm_between_sides(pair, x, start);
        const Vec3 turn = arm.cross(p.lambda[std::size_t(row)] * x.normal + p.lambda[std::size_t(row) + 1] * x.tangent +
                                    p.lambda[std::size_t(row) + 2] * x.normal.cross(x.tangent));
        EXPECT_LT((sum.moment - turn).norm(), 1e-12 * sum.size) << "row " << row;
        (pair.tool_a ? tool_rows : tissue_rows) += 1;
        exact += arm.norm() < 1e-15;
      }
    ASSERT_TRUE(s->report().finite);
  }
  EXPECT_GT(tool_rows, 50);
  EXPECT_GT(tissue_rows, 50);
  EXPECT_GT(exact, tool_rows / 2);
}

TEST(Contact, SurfacesDoNotPassThroughOneAnother) {
  SceneFolder folder;
  auto s = soft_bench(
      folder,
      R"(<contact between="left right pad top" friction="0.1" tissue_spacing="3 mm" tissue_max_contacts="60"/>)");
  ASSERT_TRUE(s);
  const auto surfaces = s->surfaces();
  double deepest = 0;
  for (int i = 0; i < 120; ++i) {
    press(*s, i);
    s->step();
    // Vertices of the top's lower face over the pad's upper one.
    CollisionMesh mesh;
    surfaces[0]->update();
    surfaces[1]->update();
    mesh.build(surfaces[0]->rest().vertices, surfaces[0]->triangles());
    mesh.update(surfaces[0]->positions(), {});
    for (std::size_t v = 0; v < surfaces[1]->positions().size(); ++v) {
      if (surfaces[1]->rest().vertices[v].z() > 0.001) continue;
      std::vector<Proximity> found;
      TissueCollider one(std::vector<int>{int(v)}, surfaces[1]->positions(), int(surfaces[0]->triangles().size()));
      CollisionMesh other;
      other.build(surfaces[1]->rest().vertices, surfaces[1]->triangles());
      other.update(surfaces[1]->positions(), {});
      one.detect(other, mesh, {.alarm = 1e-3, .max_correction = 1, .max_depth = 2e-3}, found);
      for (const auto& x : found) deepest = std::min(deepest, x.gap);
    }
  }
  EXPECT_GT(deepest, -3e-4);
  RecordProperty("deepest_um", int(1e6 * deepest));
}

TEST(Contact, TheSameBitsTwiceAfterResetAndForAnyThreads) {
  const auto run = [](Simulation& s) {
    std::vector<std::uint64_t> hashes;
    for (int i = 0; i < 80; ++i) {
      press(s, i);
      s.step();
      hashes.push_back(s.state_hash());
    }
    return hashes;
  };
  SceneFolder folder;
  const std::string contact = R"(<contact between="left right pad top" friction="0.2"/>)";
  auto s = soft_bench(folder, contact);
  auto t = soft_bench(folder, contact);
  ASSERT_TRUE(s && t);
  const auto first = run(*s);
  EXPECT_EQ(first, run(*t));
  s->reset();
  EXPECT_EQ(first, run(*s));
}

TEST(Contact, ThePairNamedByFewestElementsWins) {
  SceneFolder folder;
  auto s = soft_bench(folder, R"(<contact id="all" between="left right pad top" friction="0.3"/>
<contact id="one" between="right top" friction="0.05"/>)");
  ASSERT_TRUE(s);
  const auto* all = s->scene().find_as<Contact>("all");
  const auto* one = s->scene().find_as<Contact>("one");
  EXPECT_EQ(all->pairs().size(), 5u);
  ASSERT_EQ(one->pairs().size(), 1u);
  EXPECT_EQ(one->pairs()[0].body_a()->id, "right");
  EXPECT_EQ(one->pairs()[0].body_b()->id, "top");
}

TEST(Contact, RowIdsLastWhileAContactSlides) {
  Bench b(feet_urdf(5e-3, radius), ground(), upright, R"(friction="0.2")");
  ASSERT_TRUE(b.tool);
  Pose at = b.tool->home_pose();
  at.p.z() = 0.0005;
  for (int i = 0; i < 10; ++i) b.move_to(at);
  const auto ids = [&] {
    std::vector<std::uint64_t> out;
    for (const Block& k : b.s->problem().blocks) out.push_back(k.id);
    std::sort(out.begin(), out.end());
    return out;
  };
  const auto before = ids();
  ASSERT_GE(before.size(), 4u);
  int same = 0;
  for (int i = 0; i < 50; ++i) {
    at.p.x() += 2e-4;
    b.move_to(at);
    int kept = 0;
    for (std::uint64_t id : ids()) kept += std::binary_search(before.begin(), before.end(), id);
    same += kept >= 4;
  }
  EXPECT_EQ(same, 50);
}

TEST(Contact, WrongElementsAreRefused) {
  SceneFolder folder;
  folder.write("meshes/ground.obj", test::obj_text(ground()));
  const auto message = [&](const std::string& between) {
    auto r = load_simulation_text(
        R"(<scene><obstacle id="a"><surface mesh="meshes/ground.obj"/></obstacle><obstacle id="b"><surface mesh="meshes/ground.obj"/></obstacle>
<obstacle id="bare"/><contact between=")" +
            between + R"("/></scene>)",
        folder.path() / "scene.xml", test::builtin(), 1);
    EXPECT_FALSE(r.simulation);
    return r.diagnostics.format();
  };
  EXPECT_NE(message("a").find("two names or more"), std::string::npos);
  EXPECT_NE(message("a a").find("is listed twice"), std::string::npos);
  EXPECT_NE(message("a b").find("none of these can move"), std::string::npos);
  EXPECT_NE(message("a bare").find("has no surface"), std::string::npos);
}

}  // namespace
}  // namespace insula
