// SPDX-License-Identifier: GPL-3.0-or-later
#include "engine/reports/perceptible_forces.h"

#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

namespace insula {
namespace {

/// A second without touch, then ten seconds in which the left hand's force rises by equal steps to 0.5 N.
RunRecorder rising() {
  RunRecorder recorder;
  for (int k = 1; k <= 1100; ++k) {
    StepReport r;
    r.time = 0.01 * k;
    r.finite = true;
    recorder.record(r, {}, {k <= 100 ? 0.0 : 0.5 * (k - 100) / 1000, 0.0}, 0);
  }
  return recorder;
}

TEST(PerceptibleForces, SharesOfARisingForce) {
  const RunRecorder recorder = rising();
  const PerceptibleForces left = perceptible_forces(recorder, 0);
  EXPECT_NEAR(left.touching_s, 9.9, 0.011);  // the first tenth of a second is below what counts as touch
  EXPECT_NEAR(left.median_N, 0.2525, 1e-3);
  EXPECT_NEAR(left.largest_N, 0.5, 1e-6);
  ASSERT_EQ(left.above.size(), 2u);
  EXPECT_NEAR(left.above[0].time_share, 480.0 / 990, 2e-3);
  EXPECT_NEAR(left.above[0].range_share, 1 - 0.26 / 0.5, 1e-6);
  EXPECT_NEAR(left.above[0].scale, 0.26 / 0.2525, 5e-3);
  EXPECT_NEAR(left.above[1].time_share, 880.0 / 990, 2e-3);
  const PerceptibleForces right = perceptible_forces(recorder, 1);
  EXPECT_EQ(right.touching_s, 0);
  EXPECT_EQ(right.above[0].scale, 0);
}

TEST(PerceptibleForces, AreInTheReport) {
  const auto json = nlohmann::json::parse(report_json(rising(), {}));
  const auto& left = json.at("haptic").at("perceptible").at("left");
  EXPECT_NEAR(left.at("median_N").get<double>(), 0.2525, 1e-3);
  ASSERT_EQ(left.at("above_friction").size(), 2u);
  EXPECT_EQ(left.at("above_friction")[0].at("friction_N"), 0.26);
  EXPECT_NEAR(left.at("above_friction")[0].at("time_share").get<double>(), 0.485, 2e-3);
  EXPECT_NE(report_html(rising(), {}).find("above the friction of Phantom Omni, Touch"), std::string::npos);
}

}  // namespace
}  // namespace insula
