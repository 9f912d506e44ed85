// SPDX-License-Identifier: GPL-3.0-or-later
// Walls of a thin vessel: pressed flat, met by fast blades, crossed and brought apart again.
#include <gtest/gtest.h>

#include "plugins/self_contact/vessel_for_test.h"

namespace insula {
namespace {

using test::VesselBench;

const std::string jaws = R"(<retractor id="up" model="meshes/jaw/tool.urdf" hand="right" home="0 -4.5 5 mm" shaft="0 1 0" flat="0 0 1" coupling="250 N/m"/>
<retractor id="down" model="meshes/jaw/tool.urdf" hand="left" home="0 -4.5 -5 mm" shaft="0 1 0" flat="0 0 1" coupling="250 N/m"/>)";
const std::string fine = R"(friction="0.2" spacing="0.7 mm" max_contacts="20")";

void close_jaws(VesselBench& b, double height) {
  for (int hand = 0; hand < 2; ++hand) {
    Pose at = b.s->instrument_of(hand)->home_pose();
    at.p.z() = hand == 1 ? height : -height;
    b.hand(hand, at);
  }
}

std::vector<std::uint64_t> ids(const Simulation& s) {
  std::vector<std::uint64_t> out;
  for (const Block& k : s.problem().blocks) out.push_back(k.id);
  std::sort(out.begin(), out.end());
  return out;
}

// Both jaws end 8 mm beyond the middle: 2 N on either side.
TEST(SelfContact, JawsPressAVesselFlatAndItsWallsKeepOneThickness) {
  VesselBench b(test::tube(2e-3, 16e-3, 17), 7.6e-3, jaws, "up down", fine, R"(thickness="0.3 mm" friction="0.3")");
  ASSERT_TRUE(b.s);
  for (int i = 0; i < 150; ++i) {
    close_jaws(b, 5e-3 - 13e-3 * std::min(1.0, i / 90.0));
    b.s->step();
    ASSERT_EQ(b.crossings(), 0) << i;
    for (int hand : {0, 1}) ASSERT_EQ(b.depth(*b.s->instrument_of(hand)), 0) << i;
    EXPECT_LE(b.self->contacts().size(), 20u);
    ASSERT_TRUE(b.s->report().finite);
  }
  double between = 0;
  for (std::size_t i = 0; i < b.self->contacts().size(); ++i) {
    between += b.self->forces()[i][0];
    EXPECT_GT(b.self->contacts()[i].gap, -0.05e-3);
  }
  EXPECT_GT(between, 1.0);
  EXPECT_LT(between, 2.5);
  EXPECT_GT(b.s->instrument_of(1)->pose().p.z() - b.s->instrument_of(0)->pose().p.z(), 1e-3 + 0.55e-3);
  printf("between %g rows %d dist %g\n", between, b.s->report().rows, b.s->instrument_of(1)->pose().p.z() - b.s->instrument_of(0)->pose().p.z());
  // At rest the same rows, step after step, with opposite normals under the two jaws.
  const auto before = ids(*b.s);
  int changed = 0;
  for (int i = 0; i < 120; ++i) {
    b.s->step();
    changed += ids(*b.s) != before;
  }
  EXPECT_EQ(changed, 0);
  for (const Contact::Pair& p : b.touch->pairs()) {
    if (!p.tool_a || p.tool_b) continue;
    const double up = p.tool_a->id == "up" ? 1 : -1;
    int many = 0;
    for (std::size_t i = 0; i < p.contacts.size(); ++i)
      if (p.forces[i][0] > 0) {
        EXPECT_GT(up * p.contacts[i].normal.z(), 0.7);
        ++many;
      }
    EXPECT_GE(many, 4);
    printf("contacts %zu loaded %d\n", p.contacts.size(), many);
  }
}

const std::string blade = R"(<retractor id="blade" model="meshes/blade/tool.urdf" hand="right" home="0 0 30 mm" shaft="0 0 1" flat="1 0 0" coupling="250 N/m"/>)";

// 0.5 m/s: in a step the hand moves twice as far as the vessel is wide.
TEST(SelfContact, FastBladesNeverGoThroughAWallNorPressOneWallThroughTheOther) {
  VesselBench b(test::tube(2e-3, 12e-3, 15), 5.8e-3, blade, "blade", fine, R"(thickness="0.3 mm" friction="0.3")", 100);
  ASSERT_TRUE(b.s);
  auto* tool = b.s->scene().find_as<Instrument>("blade");
  shapes::Random r(7);
  const double step = 0.5 * b.s->h();
  const int poses = getenv("POSES") ? atoi(getenv("POSES")) : 1000, from = getenv("FROM") ? atoi(getenv("FROM")) : 0;
  int touched = 0, bad = 0;
  for (int k = 0; k < poses; ++k) {
    const Vec3 target(r.between(-3e-3, 3e-3), r.between(-1e-3, 1e-3), r.between(-1e-3, 1e-3));
    Vec3 d = r.direction();
    d.x() *= 0.5;
    d.normalize();
    const Vec3 turn = r.in_box(0.3), spin = r.direction();
    const double start = r.between(0, step);
    if (k < from) continue;
    b.s->reset();
    // Tip first, edge first, flat first.
    const Vec3 z = k % 3 == 0 ? Vec3(-d) : d.cross(spin).normalized();
    const Vec3 x = k % 3 == 1 ? d.cross(z) : k % 3 == 2 ? d : d.cross(spin).normalized();
    Mat3 axes;
    axes << x, z.cross(x), z;
    Pose at;
    at.q = (from_rotation_vector(turn) * Quat(axes)).normalized();
    at.p = target - d * (7e-3 + start) - (k % 3 == 0 ? Vec3(Vec3::Zero()) : Vec3(6e-3 * (at.q * Vec3::UnitZ())));
    tool->place(at);
    b.hand(1, at);
    if (b.depth(*tool) > 0) continue;
    for (int i = 0; i < 6; ++i) {
      if (i < 3) at.p += step * d;
      b.hand(1, at);
      b.s->step();
      const int crossings = b.crossings();
      const double depth = b.depth(*tool);
      double force = 0;
      for (const ContactPoint& c : b.s->report().contacts) force += c.normal_force;
      touched += force > 0;
      if (crossings || depth > 0) {
        ++bad;
        printf("pose %d kind %d step %d: crossings %d depth %g force %g rows %d sweeps %d\n", k, k % 3, i, crossings, depth, force, b.s->report().rows, b.s->report().solve.sweeps);
      }
    }
  }
  printf("bad %d touched %d\n", bad, touched);
  EXPECT_EQ(bad, 0);
  EXPECT_GT(touched, poses);
}

}  // namespace
}  // namespace insula
