// SPDX-License-Identifier: GPL-3.0-or-later
// Largest force, mean and impulse of the hands on a structure, against sums by hand.
#include "engine/reports/force_record.h"

#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "core/mechanics/obstacle.h"
#include "engine/reports/report_writer.h"

namespace insula {
namespace {

struct Forces {
  Obstacle floor, bone;
  StepReport report;
  Forces() {
    floor.id = "floor";
    bone.id = "bone";
    report.structures = {{&floor}, {&bone}};
    report.h = 0.1;
  }
  const StepReport& push(double left_N, double right_N) {
    report.structures[0].of_hand = {Vec3(0, -left_N, 0), Vec3(0.6 * right_N, 0, 0.8 * right_N)};
    return report;
  }
};

TEST(ForceRecord, TakesTheLargerHandOfEachStep) {
  Forces f;
  ForceRecord record;
  for (const auto& [left, right] : {std::pair(0.0, 0.0), {0.2, 0.0}, {0.2, 0.4}, {0.0, 0.3}})
    record.observe(f.push(left, right));
  const auto json = record.json();
  ASSERT_EQ(json.size(), 2u);
  EXPECT_NEAR(json.at("floor").at("max_N").get<double>(), 0.4, 1e-12);
  EXPECT_NEAR(json.at("floor").at("impulse_Ns").get<double>(), 0.1 * (0.2 + 0.4 + 0.3), 1e-12);
  EXPECT_NEAR(json.at("floor").at("mean_N").get<double>(), 0.3, 1e-12) << "while touched";
  for (const char* key : {"max_N", "mean_N", "impulse_Ns"}) EXPECT_EQ(json.at("bone").at(key), 0) << key;
  EXPECT_NE(record.html().find("<td>floor</td>"), std::string::npos);
  EXPECT_EQ(record.html().find("<td>bone</td>"), std::string::npos) << "nobody touched it";
}

TEST(ForceRecord, IsPartOfTheReport) {
  Forces f;
  RunRecorder recorder;
  recorder.record(f.push(0, 0.25), {}, {0, 0}, 0);
  const auto json = nlohmann::json::parse(report_json(recorder, RunSummary()));
  EXPECT_NEAR(json.at("force_on").at("floor").at("max_N").get<double>(), 0.25, 1e-12);
  recorder.clear();
  EXPECT_TRUE(nlohmann::json::parse(report_json(recorder, RunSummary())).at("force_on").empty());
}

}  // namespace
}  // namespace insula
