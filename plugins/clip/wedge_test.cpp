// SPDX-License-Identifier: GPL-3.0-or-later
// A clip wedged among rigid things. Its contacts carry no more than `max_force`, and it does not fly off.
#include "plugins/clip/clip_for_test.h"

namespace insula {
namespace {

using test::ClipBench;

constexpr double bound = 2, friction = 0.2;

/// Two fixed plates, 20 mm thick, with a gap of this width between them, z from low to high.
std::string plates(ClipBench& bench, double gap, double low, double high) {
  std::string out;
  for (const double side : {-1.0, 1.0}) {
    const std::string name = side < 0 ? "left" : "right";
    const double inner = side * 0.5 * gap, outer = side * (0.5 * gap + 20e-3);
    bench.folder.write("meshes/" + name + ".obj",
                       test::obj_text(shapes::box(Vec3(std::min(inner, outer), -12e-3, low),
                                                  Vec3(std::max(inner, outer), 12e-3, high), 6)));
    out += R"(<obstacle id=")" + name + R"("><surface mesh="meshes/)" + name +
           R"(.obj" mesh_unit="m" material="bone"/></obstacle>)";
  }
  return out;
}

std::string contact(const std::string& limit) {
  return fmt::format(R"(<contact between="clip left right" friction="{}" max_correction="0.2 mm" {}/>)", friction,
                     limit);
}

const std::string limited = fmt::format(R"(max_force="{} N")", bound);

/// The largest normal force of a contact in the last step, N. Friction keeps its cone.
double largest_force(const Simulation& s) {
  double most = 0;
  for (const ContactPoint& c : s.report().contacts) {
    most = std::max(most, c.normal_force);
    EXPECT_LE(c.tangent_force.norm(), friction * c.normal_force * (1 + 1e-6) + 1e-9);
  }
  return most;
}

// An applier opens the jaws as far as they go, and the plates leave them half of that.
TEST(WedgedClip, JawsThatAnApplierOpensBetweenPlatesPressNoHarderThanTheBound) {
  const auto open = [](const std::string& limit, double* moved = nullptr) {
    ClipBench bench;
    const std::string both = plates(bench, 5e-3, -12e-3, 9e-3);
    double most = 0;
    if (!bench.load(both + ClipBench::clip_element("") +
                    ClipBench::applier_element(R"(load="clip" coupling="500 N/m")") + contact(limit)))
      return most;
    const Pose home{Vec3(0, 0, test::hinge_z), Quat::Identity()};
    for (int n = 0; n < 240; ++n) {
      bench.run(home, 1, n < 120);
      EXPECT_TRUE(bench.s->report().finite);
      most = std::max(most, largest_force(*bench.s));
      if (n == 119 && !limit.empty()) {
        EXPECT_GT(bench.clip->opening(), 0.9 * test::widest);
      }
      if (moved) *moved = std::max(*moved, bench.clip->pose().p.norm());
    }
    EXPECT_LT(bench.clip->opening(), 1e-3) << "the jaws came out of the plates";
    EXPECT_LT(bench.clip->momentum().norm(), 1e-6);
    return most;
  };
  double moved = 0;
  const double most = open(limited, &moved);
  EXPECT_NEAR(most, bound, 1e-9);
  EXPECT_LT(moved, 1e-3) << "it flew off";
}

// The coil is 2.4 mm thick.
TEST(WedgedClip, AReleasedClipInATooNarrowGapStaysThere) {
  for (const double gap : {2.0e-3, 2.3e-3}) {
    SCOPED_TRACE(fmt::format("gap {} mm", 1e3 * gap));
    ClipBench bench;
    const std::string both = plates(bench, gap, 10e-3, 18e-3);
    ASSERT_TRUE(bench.load(both + ClipBench::clip_element(R"(start="field")") + contact(limited)));
    double most = 0;
    for (int n = 0; n < 120; ++n) {
      bench.s->step();
      ASSERT_TRUE(bench.s->report().finite);
      most = std::max(most, largest_force(*bench.s));
    }
    EXPECT_GT(most, 0.5 * bound) << "it is not wedged";
    EXPECT_LE(most, bound * (1 + 1e-9));
    EXPECT_LT(bench.clip->pose().p.norm(), 0.5e-3) << "it flew off";
    EXPECT_LT(bench.clip->momentum().norm(), 30e-3 * 1e-3) << "30 g at 1 mm/s";
  }
}

TEST(WedgedClip, WithoutABoundTheSameGapAsksForAnyForce) {
  ClipBench bench;
  const std::string both = plates(bench, 2.0e-3, 10e-3, 18e-3);
  ASSERT_TRUE(bench.load(both + ClipBench::clip_element(R"(start="field")") + contact("")));
  double most = 0;
  for (int n = 0; n < 60; ++n) {
    bench.s->step();
    most = std::max(most, largest_force(*bench.s));
  }
  EXPECT_GT(most, 50 * bound);
}

}  // namespace
}  // namespace insula
