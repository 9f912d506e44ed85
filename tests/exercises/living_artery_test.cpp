// SPDX-License-Identifier: GPL-3.0-or-later
// The shipped arteries as scenes get them from scenes/parts/artery.xml: they pulse as they should and are otherwise at
// rest.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cstdio>

#include "core/registry/registry.h"
#include "core/sim/simulation.h"
#include "plugins/pressure/pressure.h"

namespace insula {
namespace {

class LivingArtery : public ::testing::TestWithParam<const char*> {};

TEST_P(LivingArtery, PulsesByFiveToEightPercentAndTouchesItselfNowhere) {
  Registry registry;
  register_builtin(registry);
  const auto text = fmt::format(R"(<scene time_step="16.6667 ms">
  <include file="../parts/artery.xml"><variable name="artery_case" value="{}"/></include>
</scene>)",
                                GetParam());
  auto loaded = load_simulation_text(
      text, std::filesystem::path(INSULA_SOURCE_DIR) / "scenes" / "training" / "artery.xml", registry, 1);
  ASSERT_TRUE(loaded.simulation) << loaded.diagnostics.format();
  Simulation& s = *loaded.simulation;
  const auto* heart = s.scene().find_as<BloodPressure>("heart");
  ASSERT_TRUE(heart);
  const int sac = heart->chambers().find("sac");
  ASSERT_GE(sac, 0);
  double least = 1e300, most = 0;
  for (int i = 0; i < 180; ++i) {
    s.step();
    ASSERT_TRUE(s.report().finite);
    for (const ContactPoint& c : s.report().contacts) EXPECT_LT(c.normal_force, 1e-6) << "step " << i;
    if (i < 60) continue;  // the first beat brings it into its rhythm
    least = std::min(least, heart->volume(sac));
    most = std::max(most, heart->volume(sac));
  }
  const double change = (most - least) / heart->rest_volume(sac);
  EXPECT_GT(change, 0.05);
  EXPECT_LT(change, 0.08);
  std::printf("sac volume changes by %.2f %%\n", 100 * change);
}

INSTANTIATE_TEST_SUITE_P(Cases, LivingArtery, ::testing::Values("narrow_neck", "anterior_superior", "wide_neck"),
                         [](const auto& p) { return std::string(p.param); });

}  // namespace
}  // namespace insula
