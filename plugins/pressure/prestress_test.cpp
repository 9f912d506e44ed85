// SPDX-License-Identifier: GPL-3.0-or-later
// A wall that bears the pressure of its image: balance there, slackness without pressure.
#include <gtest/gtest.h>

#include "core/testing/held.h"
#include "plugins/membrane/shell_for_test.h"
#include "plugins/pressure/pressure.h"
#include "plugins/pressure/shell_for_test.h"

namespace insula {
namespace {

using test::mmHg;
constexpr double radius = 0.004, young = 0.9e6, thickness = 2e-4, poisson = 0.45;

/// What feeds the single chamber of a shell: a stiff source whose pressure a test sets.
struct Source final : ChamberFeed {
  double pressure = 93 * mmHg;
  double reference(int) const override { return 93 * mmHg; }
  void reduce(const StepContext&, StarMesh& m) override { m.ground(0, 1e-7, pressure); }
  void settle(const StepContext&, const double*, const double*) override {}
};

struct Sac : test::TestScene {
  Source source;
  BloodPressure* pressure = nullptr;
  explicit Sac(const TriMesh& mesh, const std::string& support = {}, const std::string& attributes = {}) {
    folder.write("meshes/sac.obj", test::obj_text(mesh));
    load(fmt::format(R"(<scene time_step="16 ms"><solver tolerance="1e-14 m"/>
  <shell_body id="artery" mesh="meshes/sac.obj" mesh_unit="m">
    <membrane thickness="0.2 mm" young="0.9 MPa" poisson="0.45" added_mass="1 kg/m2" mass_damping="20 1/s"/>{}</shell_body>
  <pressure id="p" on="artery" systolic="93 mmHg" diastolic="93 mmHg" {}/></scene>)",
                     support, attributes));
    if (!s) return;
    pressure = &get<BloodPressure>("p");
    pressure->set_feed(&source);
  }
  double moved() {
    double most = 0;
    for (int i = 0; i < shell().nodes(); ++i)
      most = std::max(most, (shell().q().segment<3>(3 * i) - shell().rest_nodes()[std::size_t(i)]).norm());
    return most;
  }
};

/// A sac on a stalk: a ball drawn out below, where it is curved in both directions.
TriMesh pear() {
  TriMesh m = test::ball(Vec3::Zero(), radius, 3);
  for (Vec3& v : m.vertices)
    if (const double z = v.z() / radius; z < 0) {
      const double narrow = 1 - 0.45 * z * z * (3 + 2 * z);
      v = Vec3(narrow * v.x(), narrow * v.y(), v.z() * (1 + 0.8 * z * z));
    }
  return m;
}

TEST(Prestress, ImagedShapeIsInBalanceAtItsPressure) {
  for (const TriMesh& mesh :
       {test::ball(Vec3(0.03, 0, 0), radius, 3), test::tube(Vec3(0, 0.02, 0), 0.002, 0.012, 16, 16), pear()}) {
    Sac t(mesh);
    ASSERT_TRUE(t.pressure) << t.messages;
    t.run(60);
    EXPECT_TRUE(test::held("the imaged shape stands still, m", t.moved(), 1, 1e-9));
    EXPECT_NEAR(t.pressure->pressure(0), 93 * mmHg, 1e-3);
    t.s->reset();
    t.run(1);
    EXPECT_TRUE(test::held("the imaged shape stands still, m", t.moved(), 1, 1e-9));
  }
}

TEST(Prestress, IsFoundOnceMoreForWhatIsMissing) {
  Sac t(pear(), {}, "prestress=\"false\"");
  ASSERT_TRUE(t.pressure) << t.messages;
  ShellBody& body = t.shell();
  VecX load = VecX::Zero(3 * body.nodes());
  std::vector<Vec3> g;
  t.pressure->chambers().gradient(0, body.q(), g);
  for (std::size_t i = 0; i < g.size(); ++i) load.segment<3>(3 * t.pressure->chambers().nodes(0)[i]) = 1e4 * g[i];
  EXPECT_LE(body.prestress(load), 1e-10);
  EXPECT_LE(body.prestress(1.2 * load), 1e-10);
  VecX f = 1.2 * load;
  for (ForceModel* m : body.forces()) m->linearise(body.q().data(), f.data(), nullptr, 0.01, Tangent::system);
  EXPECT_LT(f.norm(), 2e-10 * load.norm());
}

TEST(Prestress, WithoutPressureASphereIsSmallerAndSmooth) {
  // No tension: the linear law shrinks it by p0 r0 (1 - nu) / (2 E t).
  Sac t(test::icosphere(radius, 3));
  ASSERT_TRUE(t.pressure) << t.messages;
  ShellBody& body = t.shell();
  const double shrunk = 93 * mmHg * radius * (1 - poisson) / (2 * young * thickness);
  t.source.pressure = 0;
  t.run(100);
  EXPECT_NEAR(t.pressure->pressure(0), 0, 1);
  const double now = std::cbrt(t.pressure->volume(0) / t.pressure->rest_volume(0));
  EXPECT_TRUE(test::held("shrinking without pressure", std::abs(1 - now - shrunk), shrunk, 0.03));
  double turned = 0;
  for (const auto& w : body.wall_triangles()) {
    const auto normal = [&](auto&& at) { return (at(w[1]) - at(w[0])).cross(at(w[2]) - at(w[0])).normalized(); };
    const Vec3 then = normal([&](int v) -> Vec3 { return body.rest_nodes()[std::size_t(v)]; });
    const Vec3 after = normal([&](int v) -> Vec3 { return body.q().segment<3>(3 * v); });
    turned = std::max(turned, std::acos(std::min(1.0, then.dot(after))));
  }
  EXPECT_LT(turned, 2 * std::numbers::pi / 180);
  // And back.
  t.source.pressure = 93 * mmHg;
  t.run(200);
  EXPECT_TRUE(test::held("the imaged shape stands still, m", t.moved(), 1, 1e-9));
}

/// Newtons a metre of a dome's top, its lower half held.
double dome_stiffness(double pressure) {
  Sac t(test::ball(Vec3::Zero(), radius, 3), R"(<fixed region="beyond" centre="0 0 0.1 mm" normal="0 0 -1"/>)");
  EXPECT_TRUE(t.pressure) << t.messages;
  t.source.pressure = pressure;
  t.run(200);
  ShellBody& body = t.shell();
  int top = 0;
  for (int i = 0; i < body.nodes(); ++i)
    if (body.rest_nodes()[std::size_t(i)].z() > body.rest_nodes()[std::size_t(top)].z()) top = i;
  const double before = body.q()[3 * top + 2], force = 1e-3;
  body.external[3 * top + 2] = -force;
  t.run(200);
  return force / (before - body.q()[3 * top + 2]);
}

// The share of its displacement that a pushed sac still lacks after each of ten steps.
std::vector<double> displacement_left(bool with_gradient) {
  Sac t(pear(), R"(<fixed region="beyond" centre="0 0 -4 mm" normal="0 0 -1"/>)");
  EXPECT_TRUE(t.pressure) << t.messages;
  ShellBody& body = t.shell();
  EXPECT_EQ(body.filling_gradient, t.pressure);
  if (!with_gradient) body.filling_gradient = nullptr;
  t.run(20);
  int side = 0;
  for (int i = 0; i < body.nodes(); ++i)
    if (body.rest_nodes()[std::size_t(i)].x() > body.rest_nodes()[std::size_t(side)].x()) side = i;
  body.external[3 * side + 1] = 2e-3;
  std::vector<double> at;
  for (int n = 0; n < 400; ++n) {
    t.run(1);
    at.push_back(body.q()[3 * side + 1]);
  }
  const double start = body.rest_nodes()[std::size_t(side)].y();
  std::vector<double> left;
  for (std::size_t n = 0; n < 10; ++n) left.push_back((at.back() - at[n]) / (at.back() - start));
  return left;
}

// A sac that is pushed sideways turns on its stalk, and the pressure turns with it.
TEST(Prestress, APushedSacReachesItsPlaceWithinAFewSteps) {
  const auto left = displacement_left(true);
  for (std::size_t n = 1; n < left.size(); ++n) EXPECT_LT(std::abs(left[n]), 0.55 * std::abs(left[n - 1])) << n;
  EXPECT_LT(left.back(), 2e-3);
  EXPECT_GT(displacement_left(false).back(), 0.1) << "the gradient of the load makes no difference";
}

TEST(Prestress, DomeWithoutPressureIsSoft) {
  const double full = dome_stiffness(93 * mmHg), slack = dome_stiffness(0);
  EXPECT_GT(slack, 0);
  EXPECT_LT(slack, 0.6 * full);
}

}  // namespace
}  // namespace insula
