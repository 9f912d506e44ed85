// SPDX-License-Identifier: GPL-3.0-or-later
// What the two tangents are worth in a Newton iteration. Elements by themselves: element_batch_test.cpp; bars, beams
// and patches: tests/physics.
#include <gtest/gtest.h>

#include "core/mechanics/soft_body.h"
#include "core/testing/block_mesh.h"
#include "core/testing/example.h"
#include "core/testing/held.h"

namespace insula {
namespace {

std::unique_ptr<Simulation> bar(const std::string& fem, const test::SceneFolder& folder) {
  folder.write("meshes/bar.msh", test::gmsh_text(test::block_mesh({6, 2, 2}, Vec3(0, 0, 0), Vec3(0.06, 0.02, 0.02))));
  return test::load_text(
      "<scene><soft_body id=\"bar\" mesh=\"meshes/bar.msh\" mesh_unit=\"m\"><corotational_fem " + fem +
          "/><fixed region=\"beyond\" centre=\"0.001 0 0 m\" normal=\"-1 0 0\"/></soft_body></scene>",
      folder.path() / "bar.xml");
}

/// Static Newton on a bent bar: residual force after each step, N.
std::vector<double> newton(SoftBody& body, int steps) {
  for (int i = 0; i < body.nodes(); ++i)
    if (body.rest().nodes[std::size_t(i)].x() > 0.0599) body.external[3 * i + 2] = -2e-4;
  std::vector<double> residual;
  StepContext context;
  context.h = 1e6;
  for (int k = 0; k < steps; ++k) {
    body.v().setZero();
    body.rows.clear();
    body.free_motion(context);
    body.apply(context, body.rows, nullptr);
    VecX f = body.external;
    for (ForceModel* m : body.forces()) m->linearise(body.q().data(), f.data(), nullptr, 0, Tangent::system);
    double worst = 0;
    for (int i = 0; i < body.nodes(); ++i)
      if (!body.fixed()[std::size_t(i)]) worst = std::max(worst, f.segment<3>(3 * i).norm());
    residual.push_back(worst);
  }
  return residual;
}

TEST(CorotationalFem, BothTangentsReachTheSameEquilibrium) {
  test::SceneFolder folder;
  auto rotated = bar("young=\"3 kPa\" poisson=\"0.3\" rayleigh_stiffness=\"0 s\"", folder);
  auto exact = bar("young=\"3 kPa\" poisson=\"0.3\" rayleigh_stiffness=\"0 s\" tangent=\"exact\"", folder);
  ASSERT_TRUE(rotated && exact);
  auto& a = *rotated->scene().find_as<SoftBody>("bar");
  auto& b = *exact->scene().find_as<SoftBody>("bar");
  const auto slow = newton(a, 200), fast = newton(b, 200);
  EXPECT_LT(slow.back(), 1e-12);
  EXPECT_LT(fast.back(), 1e-12);
  EXPECT_TRUE(test::held("both tangents, one equilibrium, m", (a.q() - b.q()).lpNorm<Eigen::Infinity>(), 1, 1e-9));
  EXPECT_GT((a.q() - rotated->scene().find_as<SoftBody>("bar")->rest().nodes[0][0] * VecX::Ones(a.q().size())).norm(),
            0);
}

// Two models with different damping: the body finds its retardation times in the first step of each run.
TEST(CorotationalFem, BesideAnotherModelResetGivesTheSameBits) {
  test::SceneFolder folder;
  folder.write("meshes/bar.msh", test::gmsh_text(test::block_mesh({6, 2, 2}, Vec3(0, 0, 0), Vec3(0.06, 0.02, 0.02))));
  const auto s = test::load_text(
      R"(<scene gravity="0 0 -9.81 m/s2"><soft_body id="bar" mesh="meshes/bar.msh" mesh_unit="m">
      <corotational_fem young="3 kPa" rayleigh_stiffness="20 ms"/>
      <corotational_fem young="1 kPa" rayleigh_stiffness="5 ms"/>
      <fixed region="beyond" centre="0.001 0 0 m" normal="-1 0 0"/></soft_body></scene>)",
      folder.path() / "bar.xml");
  ASSERT_TRUE(s);
  const VecX& q = s->scene().find_as<SoftBody>("bar")->q();
  std::vector<double> first, again;
  for (auto* kept : {&first, &again}) {
    s->reset();
    for (int i = 0; i < 20; ++i) {
      s->step();
      kept->insert(kept->end(), q.data(), q.data() + q.size());
    }
  }
  EXPECT_EQ(first, again);
}

TEST(CorotationalFem, MassIsDensityTimesVolume) {
  test::SceneFolder folder;
  auto s = bar("density=\"1.2 g/cm3\"", folder);
  ASSERT_TRUE(s);
  double mass = 0;
  for (double m : s->scene().find_as<SoftBody>("bar")->node_mass()) mass += m;
  EXPECT_TRUE(test::held("mass = density volume, kg", std::abs(mass - 1200 * 0.06 * 0.02 * 0.02), 1, 1e-12));
}

// A twist by several turns' worth of steps: elements follow their own rotation without flipping back.
TEST(CorotationalFem, SpinningBodyKeepsItsShape) {
  test::SceneFolder folder;
  folder.write("meshes/cube.msh",
               test::gmsh_text(test::block_mesh({2, 2, 2}, Vec3::Constant(-0.01), Vec3::Constant(0.01))));
  auto s = test::load_text(
      "<scene time_step=\"2 ms\"><soft_body id=\"cube\" mesh=\"meshes/cube.msh\" mesh_unit=\"m\"><corotational_fem "
      "young=\"50 kPa\" rayleigh_mass=\"0 1/s\"/></soft_body></scene>",
      folder.path() / "cube.xml");
  ASSERT_TRUE(s);
  auto& body = *s->scene().find_as<SoftBody>("cube");
  const Vec3 spin(0, 0, 30);
  for (int i = 0; i < body.nodes(); ++i) body.v().segment<3>(3 * i) = spin.cross(body.rest().nodes[std::size_t(i)]);
  double turned = 0;
  Vec3 before = body.rest().nodes.front();
  for (int n = 0; n < 400; ++n) {
    s->step();
    const Vec3 now = body.q().head<3>();
    turned += std::atan2(before.cross(now).z(), before.head<2>().dot(now.head<2>()));
    before = now;
    for (int i = 1; i < body.nodes(); ++i) {
      const double rest = (body.rest().nodes[std::size_t(i)] - body.rest().nodes[0]).norm();
      ASSERT_NEAR((body.q().segment<3>(3 * i) - body.q().head<3>()).norm(), rest, 0.1 * rest) << "step " << n;
    }
  }
  EXPECT_GT(turned, 2 * 3.14159265358979) << "it stopped turning";
}

}  // namespace
}  // namespace insula
