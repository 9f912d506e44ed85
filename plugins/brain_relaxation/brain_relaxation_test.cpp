// SPDX-License-Identifier: GPL-3.0-or-later
// The volume over time, and what it does to free and to confined tissue, against closed forms.
#include <gtest/gtest.h>

#include <cmath>

#include "core/mechanics/soft_body.h"
#include "core/sim/simulation.h"
#include "core/testing/block_mesh.h"
#include "core/testing/example.h"
#include "core/testing/held.h"

namespace insula {
namespace {

constexpr double side = 0.02, young = 2100, poisson = 0.45, h = 0.01;

/// A cube of tissue; `support` fixes nodes.
struct Cube {
  test::SceneFolder folder;
  std::unique_ptr<Simulation> s;
  SoftBody* body = nullptr;
  explicit Cube(const std::string& attributes = "", const std::string& support = "") {
    folder.write("meshes/cube.msh",
                 test::gmsh_text(test::block_mesh({3, 3, 3}, Vec3::Constant(-side / 2), Vec3::Constant(side / 2))));
    s = test::load_text(R"(<scene time_step="10 ms"><soft_body id="cube" mesh="meshes/cube.msh" mesh_unit="m">
      <corotational_fem young="2100 Pa" poisson="0.45" rayleigh_stiffness="20 ms"/>)" +
                            support + R"(</soft_body><brain_relaxation id="brain" on="cube" )" + attributes +
                            "/></scene>",
                        folder.path() / "cube.xml");
    if (s) body = s->scene().find_as<SoftBody>("cube");
  }
  void run(int steps) {
    for (int i = 0; i < steps; ++i) s->step();
  }
  std::string ask(const std::string& command) { return s->command("ask", "brain " + command); }
  double change() const {
    const ChannelEntry* e = s->channels().find("brain.volume_change");
    return *e->channel->values(e->item);
  }
  double volume() const {
    double sum = 0;
    for (const auto& t : body->rest().tets) {
      const auto p = [&](int k) -> Vec3 { return body->q().segment<3>(3 * t[std::size_t(k)]); };
      sum += (p(1) - p(0)).cross(p(2) - p(0)).dot(p(3) - p(0)) / 6;
    }
    return sum;
  }
};

TEST(BrainRelaxation, EachMeasureComesAndGoesExponentially) {
  Cube c(R"(hyperventilation="0.02" hyperventilation_time="0.5 s" swelling="0.04" swelling_time="0.8 s")");
  ASSERT_TRUE(c.s);
  EXPECT_EQ(c.ask("hyperventilate"), "");
  EXPECT_NE(c.ask("hyperventilate"), "") << "twice";
  c.run(40);
  const double thinner = -0.02 * (1 - std::exp(-40 * h / 0.5));
  EXPECT_TRUE(test::held("brain relaxation: exponential", std::abs(c.change() - thinner), 0.02, 1e-12));
  EXPECT_EQ(c.ask("swell"), "");
  EXPECT_EQ(c.ask("ventilate_normally"), "");
  c.run(25);
  const double both = thinner * std::exp(-25 * h / 0.5) + 0.04 * (1 - std::exp(-25 * h / 0.8));
  EXPECT_TRUE(test::held("brain relaxation: sum of two", std::abs(c.change() - both), 0.04, 1e-12));
  EXPECT_NE(c.ask("faint"), "");
}

TEST(BrainRelaxation, FreeTissueChangesItsVolumeWithoutStress) {
  for (const std::string command : {"give_mannitol", "swell"}) {
    Cube c(R"(mannitol="0.06" mannitol_time="0.1 s" swelling="0.05" swelling_time="0.1 s")");
    ASSERT_TRUE(c.s);
    ASSERT_EQ(c.ask(command), "");
    c.run(1500);
    const double expected = command == "swell" ? 1.05 : 0.94, rest = side * side * side;
    EXPECT_TRUE(test::held("brain relaxation: free volume", std::abs(c.volume() / rest - expected), 1, 1e-8))
        << command;
    VecX force = VecX::Zero(c.body->q().size());
    for (ForceModel* m : c.body->forces()) m->linearise(c.body->q().data(), force.data(), nullptr, 0, Tangent::exact);
    EXPECT_LT(force.lpNorm<Eigen::Infinity>(), 1e-6 * young * side * side);
  }
}

TEST(BrainRelaxation, ConfinedTissueComesUnderPressure) {
  Cube c(R"(swelling="0.03" swelling_time="0.1 s")",
         R"(<fixed region="outside" centre="0 0 0 mm" radius="7 mm"/>)");  // all but the eight inner nodes
  ASSERT_TRUE(c.s);
  ASSERT_EQ(c.ask("swell"), "");
  c.run(1500);
  VecX force = VecX::Zero(c.body->q().size());
  for (ForceModel* m : c.body->forces()) m->linearise(c.body->q().data(), force.data(), nullptr, 0, Tangent::exact);
  double push = 0;
  for (int i = 0; i < c.body->nodes(); ++i)
    if (c.body->rest().nodes[std::size_t(i)].x() > side / 2 - 1e-6) push += force[3 * i];
  const double pressure = young / (1 - 2 * poisson) * (std::cbrt(1.03) - 1);
  EXPECT_TRUE(
      test::held("brain relaxation: confined pressure", std::abs(push / (side * side) - pressure), pressure, 1e-9));
  EXPECT_NEAR(c.volume(), side * side * side, 1e-15);
}

TEST(BrainRelaxation, ResetGivesTheSameBitsAgain) {
  Cube c(R"(mannitol_time="1 s")");
  ASSERT_TRUE(c.s);
  std::vector<double> first, second;
  for (auto* kept : {&first, &second}) {
    c.s->reset();
    c.run(2);
    EXPECT_NEAR(c.volume(), side * side * side, 1e-15);
    ASSERT_EQ(c.ask("give_mannitol"), "");
    for (int i = 0; i < 50; ++i) {
      c.run(1);
      kept->insert(kept->end(), c.body->q().data(), c.body->q().data() + c.body->q().size());
    }
  }
  EXPECT_EQ(first, second);
}

TEST(BrainRelaxation, SaysWhichBodyCannotSwell) {
  test::SceneFolder folder;
  folder.write("meshes/cube.msh", test::gmsh_text(test::block_mesh({1, 1, 1}, Vec3::Zero(), Vec3::Constant(side))));
  const auto r = load_simulation_text(R"(<scene><soft_body id="cube" mesh="meshes/cube.msh" mesh_unit="m">
      <prony_solid/></soft_body><brain_relaxation on="cube"/></scene>)",
                                      folder.path() / "cube.xml", test::builtin(), 1);
  EXPECT_FALSE(r.simulation);
  EXPECT_NE(r.diagnostics.format().find("no force model of \"cube\" can swell"), std::string::npos);
}

}  // namespace
}  // namespace insula
