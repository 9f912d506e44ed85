// SPDX-License-Identifier: GPL-3.0-or-later
// Where a run lies among a group: the side that counts, the order, and files that are none.
#include "core/sim/reference_bands.h"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>

#include "core/base/input_error.h"
#include "core/sim/exercise.h"
#include "core/testing/example.h"
#include "core/testing/temp_folder.h"
#include "engine/reports/metrics_report.h"
#include "engine/reports/review.h"

namespace insula {
namespace {

MetricValue metric(const std::string& id, double value, Better better) {
  return {id, "Text of " + id, "Insula", right_hand, true, value, "mm", 0, better};
}

/// One metric of a band file.
std::string entry(const std::string& id, const std::string& group, double low, double median, double high) {
  return fmt::format(
      R"({{"id": "{}", "hand": "right", "unit": "mm", "better": "low", "pass_mark": null, "groups":
          {{"{}": {{"sessions": 12, "median": {}, "quantiles": {{"0.25": {}, "0.75": {}}}}}}}}})",
      id, group, median, low, high);
}

std::string words(const std::vector<MetricValue>& metrics, const ReferenceBands& bands) {
  return review_html(review_of(metrics, bands, {}, {}, {}));
}

class BandsInReports : public testing::Test {
 protected:
  ReferenceBands bands(const std::string& metrics, const std::string& group = "") {
    return {folder_.write("bands.json", R"({"title": "Clipping", "metrics": [)" + metrics + "]}"), group};
  }
  test_files::TempFolder folder_;
};

TEST_F(BandsInReports, OnlyTheSideOfLessSkillCounts) {
  const ReferenceBand band{10, 8, 12, {}, "mm"};
  EXPECT_EQ(beyond_band(metric("a", 14, Better::low), band), 0.5);
  EXPECT_EQ(beyond_band(metric("a", 2, Better::low), band), 0);
  EXPECT_EQ(beyond_band(metric("a", 6, Better::high), band), 0.5);
  EXPECT_EQ(beyond_band(metric("a", 20, Better::high), band), 0);
  EXPECT_EQ(beyond_band(metric("a", 6, Better::none), band), 0.5);
  EXPECT_EQ(beyond_band(metric("a", 14, Better::none), band), 0.5);
  MetricValue unknown = metric("a", 100, Better::low);
  unknown.known = false;
  EXPECT_EQ(beyond_band(unknown, band), 0);
  EXPECT_EQ(beyond_band(metric("a", 11, Better::low), {10, 10, 10, {}, "mm"}), 2) << "all alike: 5 % of the median";
}

TEST_F(BandsInReports, TheFarthestComesFirst) {
  const auto b = bands(entry("a", "expert", 8, 10, 12) + "," + entry("b", "expert", 1, 2, 3) + "," +
                       entry("c", "expert", 1, 2, 3));
  EXPECT_EQ(b.group(), "expert");
  EXPECT_EQ(b.sessions(), 12u);
  const std::vector<MetricValue> all{metric("a", 14, Better::low), metric("b", 9, Better::low),
                                     metric("c", 2, Better::low), metric("d", 100, Better::low)};
  const auto worst = to_work_on(all, b, 3);
  ASSERT_EQ(worst.size(), 2u);
  EXPECT_EQ(worst[0]->id, "b");
  EXPECT_EQ(worst[1]->id, "a");
  const std::string html = words(all, b);
  EXPECT_NE(html.find("<li><b>Text of b (right hand)</b>: 9 mm, where the group has 1 mm to 3 mm</li>"),
            std::string::npos)
      << html;
  auto json = metrics_json(all);
  add_bands(json, all, b);
  EXPECT_EQ(json[1]["band"]["beyond"], 3);
  EXPECT_TRUE(json[1]["band"]["pass_mark"].is_null());
  EXPECT_FALSE(json[3].contains("band"));
  EXPECT_EQ(words(all, {}), "");
  EXPECT_NE(words({metric("a", 1, Better::low)}, b).find("Every metric lies within"), std::string::npos);
}

TEST_F(BandsInReports, AnotherUnitIsNotCompared) {
  const auto b = bands(entry("a", "expert", 8, 10, 12));
  MetricValue m = metric("a", 14, Better::low);
  EXPECT_NE(b.find(m), nullptr);
  m.unit = "m";
  EXPECT_EQ(b.find(m), nullptr);
}

TEST_F(BandsInReports, FilesThatDoNotFitAreRefused) {
  const std::string two = entry("a", "expert", 8, 10, 12) + "," + entry("a", "novice", 8, 10, 12);
  EXPECT_THROW(bands(two), InputError) << "which group?";
  EXPECT_EQ(bands(two, "novice").group(), "novice");
  EXPECT_THROW(bands(two, "master"), InputError);
  EXPECT_THROW(bands(entry("a", "expert", 12, 10, 8)), InputError);
  EXPECT_THROW(bands("3"), InputError);
  EXPECT_THROW(ReferenceBands(folder_.write("other.json", "{"), ""), InputError);
  EXPECT_THROW(ReferenceBands(folder_.path() / "gone.json", ""), InputError);
  bands(entry("a", "expert", 8, 10, 12));
  EXPECT_THROW(bands_for(folder_.path() / "bands.json", "", "Rupture"), InputError);
  EXPECT_EQ(bands_for(folder_.path() / "bands.json", "", "Clipping").title(), "Clipping");
}

class ShippedBands : public testing::TestWithParam<const char*> {};

TEST_P(ShippedBands, AreOfTheMetricsThatTheExercisesHave) {
  namespace fs = std::filesystem;
  int scenes = 0;
  for (const auto& entry : fs::directory_iterator(fs::path(INSULA_SOURCE_DIR) / "scenes" / GetParam())) {
    if (entry.path().extension() != ".xml") continue;
    const fs::path file = bands_beside(entry.path());
    ASSERT_FALSE(file.empty()) << entry.path();
    const auto simulation = test::load(entry.path());
    ASSERT_TRUE(simulation && simulation->exercise());
    ++scenes;
    const ReferenceBands bands = bands_for(file, "", simulation->scene().title());
    EXPECT_EQ(bands.group(), "scripted hands");
    EXPECT_GE(bands.sessions(), 10u);
    std::ifstream in(file);
    const auto json = nlohmann::json::parse(in);
    for (const auto& m : json.at("metrics")) {
      const auto all = simulation->exercise()->metrics();
      const auto same = [&](const MetricValue& v) {
        return v.id == m.at("id") && hand_name(v.hand) == m.at("hand") && v.unit == m.at("unit") &&
               better_name(v.better) == m.at("better");
      };
      EXPECT_TRUE(std::any_of(all.begin(), all.end(), same))
          << entry.path() << " has no metric " << m.at("id")
          << "; make its bands anew (tools/motions/scripted_bands.py)";
    }
  }
  EXPECT_GE(scenes, 4);
}

INSTANTIATE_TEST_SUITE_P(Folders, ShippedBands, testing::Values("training", "skills"));

}  // namespace
}  // namespace insula
