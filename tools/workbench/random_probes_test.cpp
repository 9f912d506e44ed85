// SPDX-License-Identifier: GPL-3.0-or-later
// Random probes on exercise 1: repeatable, from home, through free space, and with a force. The results' JSON.
#include "tools/workbench/random_probes.h"

#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "core/base/input_error.h"
#include "core/testing/example.h"
#include "tools/workbench/haptic_results.h"

namespace insula {
namespace {

std::unique_ptr<Simulation> exercise() {
  return load_simulation(std::filesystem::path(INSULA_SOURCE_DIR) / "scenes/training/1_sylvian_fissure.xml",
                         test::builtin(), 1, 1.0 / 60)
      .simulation;
}

bool same(const Motion& a, const Motion& b) {
  for (int h = 0; h < 2; ++h) {
    if (a.keys(h).size() != b.keys(h).size()) return false;
    for (std::size_t k = 0; k < a.keys(h).size(); ++k)
      if (a.keys(h)[k].time_s != b.keys(h)[k].time_s || a.keys(h)[k].sample.pose.p != b.keys(h)[k].sample.pose.p)
        return false;
  }
  return true;
}

TEST(RandomProbes, AreThoseOfTheirSeedAndBeginAtHome) {
  const auto s = exercise();
  ASSERT_TRUE(s);
  const auto first = random_probes(*s, 6, 1), again = random_probes(*s, 6, 1), other = random_probes(*s, 6, 2);
  ASSERT_EQ(first.size(), 6u);
  for (std::size_t k = 0; k < first.size(); ++k) {
    EXPECT_EQ(first[k].name, again[k].name);
    EXPECT_TRUE(same(first[k].motion, again[k].motion)) << first[k].name;
    EXPECT_FALSE(same(first[k].motion, other[k].motion)) << first[k].name;
    for (int h = 0; h < 2; ++h) {
      if (!first[k].motion.has(h)) continue;
      EXPECT_EQ(first[k].motion.at(h, 0).pose.p, s->instrument_of(h)->home_pose().p) << first[k].name;
    }
  }
  EXPECT_EQ(first[0].name.substr(0, 4), "tap ");
  EXPECT_EQ(first[3].name.substr(0, 8), "squeeze ");
  EXPECT_TRUE(first[3].motion.has(0) && first[3].motion.has(1));
}

// The tool meets nothing until it is next to the place, and there it presses.
TEST(RandomProbes, ReachTheirPlaceThroughFreeSpace) {
  const auto s = exercise();
  ASSERT_TRUE(s);
  for (const Probe& probe : random_probes(*s, 3, 5)) {
    SCOPED_TRACE(probe.name);
    s->reset();
    const ForceTrace forces = reference_forces(*s, probe.motion, probe.motion.duration());
    const Vec3 home = probe.motion.at(1, 0).pose.p;
    double farthest = 0, peak = 0, early = 0;
    for (const Motion::Key& k : probe.motion.keys(1)) farthest = std::max(farthest, (k.sample.pose.p - home).norm());
    bool near = false;
    for (std::size_t i = 0; i < forces.force[1].size(); ++i) {
      near = near || (probe.motion.at(1, s->h() * double(i + 1)).pose.p - home).norm() > farthest - 10e-3;
      (near ? peak : early) = std::max(near ? peak : early, forces.force[1][i].norm());
    }
    EXPECT_LT(early, 1e-6);
    EXPECT_GT(peak, 2e-3);
  }
}

TEST(RandomProbes, OfASceneWithoutSoftBodiesAreRefused) {
  auto s = test::load_text(R"(<scene title="Empty"/>)", std::filesystem::path(INSULA_SOURCE_DIR) / "scene.xml");
  ASSERT_TRUE(s);
  EXPECT_THROW(random_probes(*s, 1, 1), InputError);
}

TEST(HapticResults, JsonHasThePercentilesOfTheProbes) {
  std::vector<HapticResult> results;
  for (int k = 1; k <= 10; ++k)
    for (const char* rendering : {"held", "servo"}) {
      const bool servo = rendering == std::string("servo");
      HapticResult r{60, rendering, "tap pad " + std::to_string(k), 1, {}, 0, 0};
      r.truth.peak_N = 0.1;
      r.truth.rms = 0.01 * k * (servo ? 1 : 5);
      r.truth.onset_s = 1e-3 * (k == 3 ? -4 : 1);
      r.jump_N = servo ? 1e-3 * k : 0;
      r.rendered_peak_N = 0.1 + (servo ? 0 : 0.01 * k);
      results.push_back(r);
    }
  const auto json = nlohmann::json::parse(haptic_json(results));
  ASSERT_EQ(json["rates"].size(), 1u);
  const auto& rate = json["rates"][0];
  EXPECT_EQ(rate["hz"], 60);
  EXPECT_DOUBLE_EQ(rate["servo"]["rms_pct_p50"], 5);
  EXPECT_DOUBLE_EQ(rate["servo"]["rms_pct_p90"], 9);
  EXPECT_DOUBLE_EQ(rate["held"]["rms_pct_p50"], 25);
  EXPECT_TRUE(rate["hindsight"]["rms_pct_p50"].is_null());
  EXPECT_DOUBLE_EQ(rate["onset_ms_max"], 4);
  EXPECT_DOUBLE_EQ(rate["jump_pct_max"], 10);
  EXPECT_NEAR(rate["engine_peak_ratio_max"], 2, 1e-12);
  ASSERT_EQ(rate["probes"].size(), 10u);
  EXPECT_EQ(rate["probes"][2]["name"], "tap pad 3");
  EXPECT_EQ(rate["probes"][2]["hand"], "right");
  EXPECT_DOUBLE_EQ(rate["probes"][2]["servo_pct"], 3);
  EXPECT_DOUBLE_EQ(rate["probes"][2]["held_pct"], 15);
  EXPECT_DOUBLE_EQ(rate["probes"][2]["onset_ms"], -4);
}

}  // namespace
}  // namespace insula
