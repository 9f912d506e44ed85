// SPDX-License-Identifier: GPL-3.0-or-later
// The force that a held clip puts on tissue, floor or bone counts as its hand's. Closed form at rest: the force on the
// hand and the force of the hand on the structure are opposite, but for the clip's weight.
#include "core/testing/held.h"
#include "plugins/clip/clip_for_test.h"

namespace insula {
namespace {

using test::ClipBench;

/// Presses the tip of a held clip down by 2 mm onto the body "below", and waits until it rests.
void press(ClipBench& bench, const std::string& below) {
  ASSERT_TRUE(bench.load(below + ClipBench::clip_element("") +
                             ClipBench::applier_element(R"(load="clip" coupling="100 N/m")") +
                             R"(<contact between="clip below" friction="0.3"/>)",
                         R"(gravity="0 0 -9.81 m/s2")"));
  for (int n = 1; n <= 360; ++n) bench.run({Vec3(0, 0, 14e-3 - 2e-3 * std::min(1.0, n / 60.0)), Quat::Identity()}, 1);
}

const StructureForce& force_on(const Simulation& s, const std::string& id) {
  for (const StructureForce& f : s.report().structures)
    if (f.body->id == id) return f;
  throw std::runtime_error("no structure " + id);
}

void expect_balance(const ClipBench& bench) {
  const Vec3 weight = bench.clip->mass() * Vec3(0, 0, -9.81), felt = bench.applier->hand_force().head<3>();
  const StructureForce& below = force_on(*bench.s, "below");
  const Vec3 given = below.of_hand[1];
  EXPECT_LT(given.z(), -0.02) << "it never pressed";
  EXPECT_TRUE(
      test::held("force on a structure under a held clip, N", (felt + given - weight).norm(), given.norm(), 1e-6));
  EXPECT_EQ(below.of_hand[0], Vec3::Zero().eval()) << "the left hand does nothing";
  EXPECT_EQ(below.largest(), given.norm());
  for (const ToolReport& t : bench.s->report().tools) {
    EXPECT_NEAR(t.contact_force, given.norm(), 1e-6 * given.norm());
  }
}

TEST(HandForce, AHeldClipPressesTissue) {
  ClipBench bench;
  bench.folder.write("meshes/below.msh",
                     test::gmsh_text(test::block_mesh({4, 4, 3}, Vec3(-8, -8, -8.5) * 1e-3, Vec3(8, 8, -0.5) * 1e-3)));
  press(bench, R"(<soft_body id="below" mesh="meshes/below.msh" mesh_unit="m"><corotational_fem young="20 kPa"/>
    <fixed region="beyond" centre="0 0 -8.4 mm" normal="0 0 -1"/><surface/></soft_body>)");
  if (!HasFatalFailure()) expect_balance(bench);
}

TEST(HandForce, AHeldClipPressesBone) {
  ClipBench bench;
  bench.folder.write("meshes/below.obj",
                     test::obj_text(shapes::box(Vec3(-8, -8, -4) * 1e-3, Vec3(8, 8, -0.5) * 1e-3, 4)));
  press(bench, R"(<obstacle id="below"><surface mesh="meshes/below.obj" mesh_unit="m" material="bone"/></obstacle>)");
  if (!HasFatalFailure()) expect_balance(bench);
}

// The spring presses both sides of the bar, and nobody's hand does.
TEST(HandForce, AClipThatWasLetGoIsNoHands) {
  ClipBench bench;
  std::string bar = bench.bar(0.6e-3, 4e-3);
  bar.replace(bar.find("\"plate\""), 7, "\"below\"");
  ASSERT_TRUE(bench.load(bar + ClipBench::clip_element(R"(start="field" start_opening="0.2 rad")") +
                         R"(<contact between="clip below" friction="0.3"/>)"));
  bench.steps(60);
  EXPECT_GT(bench.clip->force(), 0.5) << "it holds the bar";
  EXPECT_EQ(force_on(*bench.s, "below").largest(), 0);
}

}  // namespace
}  // namespace insula
