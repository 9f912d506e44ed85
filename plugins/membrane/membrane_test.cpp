// SPDX-License-Identifier: GPL-3.0-or-later
// Stretch of a wall: patch test, rigid motion, mass, regions.
#include <gtest/gtest.h>

#include "core/testing/held.h"
#include "plugins/membrane/shell_for_test.h"

namespace insula {
namespace {

using test::Cut;
using test::Wall;

// A homogeneous deformation is in equilibrium on any mesh: with the rim put there, the inside must follow.
TEST(Membrane, PatchTest) {
  const auto rim = [](const Vec3& x) {
    return x.x() < 1e-9 || x.y() < 1e-9 || x.x() > 0.03 - 1e-9 || x.y() > 0.02 - 1e-9;
  };
  for (const double turn : {0.0, 2.0}) {
    auto body = test::shell(test::plate(0.03, 0.02, 6, 4, Cut::shaken), {.poisson = 0.4}, rim);
    Mat3 f = Mat3::Identity();
    f.topLeftCorner<2, 2>() << 1.08, 0.05, -0.02, 1.12;
    const Mat3 turned = from_rotation_vector(turn * Vec3(0.48, 0.6, -0.64)).toRotationMatrix() * f;
    const Vec3 shift(0.1, -0.2, 0.05);
    Random random(3);
    int inside = 0;
    for (int i = 0; i < body->nodes(); ++i) {
      Vec3 x = turned * body->rest_nodes()[std::size_t(i)] + shift;
      if (!body->fixed()[std::size_t(i)]) {
        x += 2e-4 * Vec3(random.uniform(-1, 1), random.uniform(-1, 1), random.uniform(-1, 1));
        ++inside;
      }
      body->q().segment<3>(3 * i) = x;
    }
    ASSERT_EQ(inside, 15);
    test::settle(*body, 60);
    for (int i = 0; i < body->nodes(); ++i)
      EXPECT_TRUE(test::held(
          "patch test of a wall",
          (body->q().segment<3>(3 * i) - (turned * body->rest_nodes()[std::size_t(i)] + shift)).norm(), 0.03, 1e-9))
          << "node " << i;
  }
}

// Uniaxial tension of a free strip: stress E (stretch - 1), width shrunk by nu; energy in closed form.
TEST(Membrane, UniaxialTensionHasItsClosedForm) {
  const Wall w{.thickness = 5e-4, .young = 2e5, .poisson = 0.35};
  auto body = test::shell(test::plate(0.04, 0.01, 8, 3, Cut::shaken), w);
  const double strain = 0.07;
  VecX x = body->q();
  for (int i = 0; i < body->nodes(); ++i) {
    x[3 * i] *= 1 + strain;
    x[3 * i + 1] *= 1 - w.poisson * strain;
  }
  EXPECT_NEAR(body->forces()[0]->energy(x.data()), 0.5 * w.young * strain * strain * w.thickness * 0.04 * 0.01, 1e-15);
  const VecX f = test::elastic_force(*body, x);
  double pull = 0;
  for (int i = 0; i < body->nodes(); ++i) {
    const Vec3& at = body->rest_nodes()[std::size_t(i)];
    if (at.x() > 0.04 - 1e-9) pull -= f[3 * i];
    else if (at.x() > 1e-9) {
      EXPECT_LT(f.segment<3>(3 * i).norm(), 1e-12);
    }
  }
  EXPECT_TRUE(test::held("uniaxial tension, N", std::abs(pull - w.young * strain * w.thickness * 0.01), 1, 1e-12));
}

// In uniaxial tension the force over the section that is left is the Cauchy stress. It turns with the wall.
TEST(Membrane, StressOfUniaxialTension) {
  const Wall w{.thickness = 5e-4, .young = 2e5, .poisson = 0.35};
  auto body = test::shell(test::plate(0.04, 0.01, 8, 3, Cut::shaken), w);
  const double strain = 0.07;
  const Mat3 turn = from_rotation_vector(Vec3(0.3, -1, 0.8)).toRotationMatrix();
  VecX x = body->q();
  for (int i = 0; i < body->nodes(); ++i)
    x.segment<3>(3 * i) = turn * Vec3(x[3 * i] * (1 + strain), x[3 * i + 1] * (1 - w.poisson * strain), x[3 * i + 2]);
  std::vector<Mat3> stress(body->wall_triangles().size(), Mat3::Zero());
  ASSERT_TRUE(body->forces()[0]->add_stress(x.data(), stress));
  const double expected = w.young * strain / (1 - w.poisson * strain);
  for (const Mat3& s : stress) {
    const Mat3 in_strip = turn.transpose() * s * turn;
    const Mat3 uniaxial = expected * Vec3::UnitX() * Vec3::UnitX().transpose();
    EXPECT_TRUE(test::held("stress of uniaxial tension", (in_strip - uniaxial).norm(), expected, 1e-9));
  }
}

TEST(Membrane, RigidMotionGivesNoForceOnAnyShape) {
  for (const TriMesh& mesh : {test::cylinder(0.002, 0.01, 12, 10, Cut::shaken), test::icosphere(0.003, 2),
                              test::plate(0.01, 0.01, 5, 5, Cut::criss_cross)}) {
    auto body = test::shell(mesh, {});
    const VecX rest = body->q();
    VecX noisy = test::deformed(*body, 0.1, 1);
    const double scale = test::elastic_force(*body, noisy).lpNorm<Eigen::Infinity>();
    const Quat turn = from_rotation_vector(Vec3(1.5, -2, 0.7));
    for (int i = 0; i < body->nodes(); ++i)
      noisy.segment<3>(3 * i) = turn * rest.segment<3>(3 * i) + Vec3(0.02, 0.1, -0.3);
    EXPECT_TRUE(test::held("rigid motion of a curved wall", test::elastic_force(*body, noisy).lpNorm<Eigen::Infinity>(),
                           scale, 1e-10));
    EXPECT_LT(test::elastic_force(*body, rest).lpNorm<Eigen::Infinity>(), 1e-12 * scale);
  }
}

TEST(Membrane, MassIsDensityTimesThicknessTimesAreaAndWhatIsAdded) {
  auto body =
      test::shell(test::plate(0.03, 0.02, 7, 5, Cut::shaken), {.thickness = 4e-4, .density = 1100, .added_mass = 0.3});
  double mass = 0;
  for (double m : body->node_mass()) mass += m;
  EXPECT_NEAR(mass, (1100 * 4e-4 + 0.3) * 0.03 * 0.02, 1e-15);
}

/// A strip whose right half is the region "sac".
WallModel two_regions() {
  WallModel model;
  model.wall = test::plate(0.04, 0.01, 8, 2, Cut::one_way);
  model.regions = {"parent", "sac"};
  for (const Vec3& x : model.wall.vertices) model.vertex_region.push_back(x.x() > 0.0201);
  return model;
}

TEST(Membrane, EachRegionHasItsOwnThickness) {
  ShellBody body;
  body.set_model(two_regions());
  test::add_membrane(body, {.thickness = 1e-3, .poisson = 0, .density = 1000, .regions = "parent"});
  test::add_membrane(body, {.thickness = 2e-4, .poisson = 0, .density = 1000, .regions = "sac"});
  ASSERT_EQ(test::finish(body, [](const Vec3& x) { return x.x() < 1e-9; }), "");
  double mass = 0, pulled = 0;
  for (double m : body.node_mass()) mass += m;
  // A triangle belongs to the region of most of its corners: the column of triangles across x = 20 to 25 mm is split.
  double area[2] = {0, 0};
  for (const auto& t : body.wall_triangles()) area[body.region_of_triangle(t)] += 0.5 * 0.005 * 0.005;
  EXPECT_NEAR(area[0] + area[1], 4e-4, 1e-15);
  EXPECT_TRUE(
      test::held("mass of two regions, kg", std::abs(mass - 1000 * (1e-3 * area[0] + 2e-4 * area[1])), 1, 1e-15));
  const double force = 1e-3;
  for (int i = 0; i < body.nodes(); ++i)
    if (body.rest_nodes()[std::size_t(i)].x() > 0.04 - 1e-9) {
      const double y = body.rest_nodes()[std::size_t(i)].y();
      body.external[3 * i] = force * (y < 1e-9 || y > 0.01 - 1e-9 ? 0.25 : 0.5);
      pulled += body.external[3 * i];
    }
  ASSERT_NEAR(pulled, force, 1e-15);
  test::settle(body, 40);
  // Well away from the border each half stretches by F / (E t b).
  const auto mean = [&](double at) {
    double sum = 0;
    int n = 0;
    for (int i = 0; i < body.nodes(); ++i)
      if (std::abs(body.rest_nodes()[std::size_t(i)].x() - at) < 1e-9) sum += body.q()[3 * i] - at, ++n;
    return sum / n;
  };
  EXPECT_NEAR((mean(0.01) - mean(0)) / 0.01, force / (1e6 * 1e-3 * 0.01), 2e-3 * 1e-4);
  EXPECT_NEAR((mean(0.04) - mean(0.035)) / 0.005, force / (1e6 * 2e-4 * 0.01), 1e-2 * 5e-4);
}

std::string wrong(const std::vector<std::string>& regions) {
  ShellBody body;
  body.set_model(two_regions());
  for (const std::string& r : regions) test::add_membrane(body, {.regions = r});
  return test::finish(body);
}

TEST(Membrane, RegionsAreOwnedExactlyOnce) {
  EXPECT_EQ(wrong({""}), "");
  EXPECT_EQ(wrong({"sac parent"}), "");
  EXPECT_EQ(wrong({"sac", "parent"}), "");
  EXPECT_NE(
      wrong({"parent", "sacc"}).find("\"sacc\" is no region of the wall; did you mean \"sac\"? (it has parent, sac)"),
      std::string::npos);
  EXPECT_NE(wrong({"sac"}).find("no membrane of this shell is the wall of parent"), std::string::npos);
  EXPECT_NE(wrong({"", "sac"}).find("regions: \"sac\" is the wall of membrane#1 already"), std::string::npos);
}

TEST(Membrane, RefusesWhatIsNoSurface) {
  const auto refused = [](std::vector<std::array<int, 3>> triangles) {
    ShellBody body;
    body.set_mesh({{Vec3(0, 0, 0), Vec3(1, 0, 0), Vec3(0, 1, 0), Vec3(0, 0, 1), Vec3(0, -1, 0), Vec3(2, 0, 0)},
                   std::move(triangles)});
    test::add_membrane(body, {});
    return test::finish(body);
  };
  EXPECT_NE(refused({{0, 1, 2}, {1, 0, 3}, {0, 1, 4}}).find("has 3 triangles; a wall has two at most"),
            std::string::npos);
  EXPECT_NE(refused({{0, 1, 2}, {0, 1, 3}}).find("do not agree on which side is out"), std::string::npos);
  EXPECT_NE(refused({{0, 1, 5}}).find("is flat"), std::string::npos);
}

TEST(Membrane, BelongsInAShell) {
  auto m = test::builtin().create("membrane");
  SoftBody body;
  Diagnostics diagnostics;
  PrepareContext context{diagnostics, 0.01};
  dynamic_cast<ForceModel&>(*m).attach(context, body);
  EXPECT_NE(diagnostics.format().find("belongs in a <shell_body>"), std::string::npos);
}

}  // namespace
}  // namespace insula
