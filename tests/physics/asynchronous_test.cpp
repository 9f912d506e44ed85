// SPDX-License-Identifier: GPL-3.0-or-later
// A scene with the asynchronous solver against the same scene solved exactly.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include "core/sim/simulation.h"
#include "core/testing/block_mesh.h"
#include "core/testing/example.h"
#include "core/testing/held.h"

namespace insula {
namespace {

/// A block of tissue that a probe presses, drags on and leaves; off its middle, where friction would be as good one way
/// as the other.
struct Pressed {
  test::SceneFolder folder;
  std::unique_ptr<Simulation> s;
  explicit Pressed(const std::string& solver, int threads = 1) {
    const TetMesh mesh = test::block_mesh({8, 8, 4}, Vec3(-10e-3, -10e-3, -10e-3), Vec3(10e-3, 10e-3, 0));
    folder.write("meshes/block.msh", test::gmsh_text(mesh));
    folder.write("meshes/probe/tool.urdf", test::test_tool_urdf(2e-3));
    folder.write("meshes/probe/tool.json", test::test_tool_json(0, 0));
    s = test::load_text(fmt::format(R"(<scene time_step="10 ms"><solver max_sweeps="200" tolerance="1e-9 m"/>
<soft_body id="tissue" mesh="meshes/block.msh" mesh_unit="m" {}><corotational_fem young="3 kPa" poisson="0.45" density="1 g/cm3"/>
<fixed region="beyond" centre="0 0 -9.9 mm" normal="0 0 -1"/><surface id="skin"/></soft_body>
<dissector id="probe" hand="right" sharp="never" model="meshes/probe/tool.urdf" home="0.7 0.4 2.5 mm" shaft="0 0 1" flat="1 0 0" coupling="400 N/m"/>
<contact id="touch" between="tissue probe" friction="0.3" spacing="0.5 mm" max_contacts="12"/></scene>)",
                                    solver),
                        folder.path() / "scene.xml", threads);
  }
  /// Force on the hand after each of so many steps.
  std::vector<Vec3> play(int steps) {
    std::vector<Vec3> out;
    for (int k = 0; k < steps; ++k) {
      const double t = k * s->h(), down = std::min(1.0, t / 0.3), side = std::clamp((t - 0.4) / 0.6, 0.0, 1.0),
                   up = std::clamp((t - 1.2) / 0.3, 0.0, 1.0);
      HandState hand;
      hand.present = true;
      hand.device = s->instrument_of(1)->home_pose();
      hand.device.p += Vec3(5e-3 * side, 2e-3 * side, -4.5e-3 * down + 8e-3 * up);
      s->set_hand(1, hand);
      s->step();
      EXPECT_TRUE(s->report().finite);
      out.push_back(s->report().tools.at(0).hand_force.head<3>());
    }
    return out;
  }
};

TEST(Asynchronous, ForcesAreThoseOfTheExactStepWithinTwoPercent) {
  Pressed exact(R"(solver="direct")"), near(R"(solver="asynchronous")");
  ASSERT_TRUE(exact.s && near.s);
  const auto a = exact.play(160), b = near.play(160);
  double peak = 0, square = 0;
  std::vector<double> error;
  for (std::size_t i = 0; i < a.size(); ++i) {
    peak = std::max(peak, a[i].norm());
    error.push_back((a[i] - b[i]).norm());
    square += (a[i] - b[i]).squaredNorm();
  }
  std::sort(error.begin(), error.end());
  EXPECT_GT(peak, 0.1);
  // But for the few steps in which a contact lets go in one of the two and a step later in the other.
  EXPECT_LT(error[error.size() - 4], 0.02 * peak);
  EXPECT_LT(error.back(), 0.08 * peak);
  EXPECT_TRUE(test::held("asynchronous forces, rms", std::sqrt(square / double(a.size())), peak, 0.005));
  EXPECT_GT(near.s->report().solver.factors, 1) << "and a factor has been changed on the way";
}

TEST(Asynchronous, TheSameInputGivesTheSameBits) {
  Pressed one(R"(solver="asynchronous")", 1), two(R"(solver="asynchronous")", 2);
  ASSERT_TRUE(one.s && two.s);
  one.play(120);
  two.play(120);
  EXPECT_EQ(one.s->state_hash(), two.s->state_hash());
  one.s->reset();
  one.play(120);
  EXPECT_EQ(one.s->state_hash(), two.s->state_hash());
}

TEST(Asynchronous, SinglePrecisionIsWithinAThousandth) {
  Pressed exact(R"(solver="direct")"), single(R"(solver="single")");
  ASSERT_TRUE(exact.s && single.s);
  const auto a = exact.play(120), b = single.play(120);
  double peak = 0, worst = 0;
  for (std::size_t i = 0; i < a.size(); ++i) {
    peak = std::max(peak, a[i].norm());
    worst = std::max(worst, (a[i] - b[i]).norm());
  }
  EXPECT_LT(worst, 1e-3 * peak);
}

TEST(Asynchronous, WhatIsLeftIsInTheReport) {
  Pressed near(R"(solver="asynchronous" solver_tolerance="1e-5 mm")");
  ASSERT_TRUE(near.s);
  near.play(60);
  EXPECT_GT(near.s->report().solver.iterations, 0);
  EXPECT_LE(near.s->report().solver.residual_m, 1e-8);
  EXPECT_GT(near.s->report().solver.age, 0);
}

}  // namespace
}  // namespace insula
