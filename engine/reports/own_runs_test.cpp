// SPDX-License-Identifier: GPL-3.0-or-later
// Earlier runs of the same person: which count, which is the last and which the best.
#include "engine/reports/own_runs.h"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include "core/testing/temp_folder.h"
#include "engine/reports/review.h"

namespace insula {
namespace {

class OwnRunsTest : public testing::Test {
 protected:
  struct Said {
    std::string title = "Clipping", person = {}, mode = "practice", state = "done";
    double seconds = 60;
    int faults = 0;
    double path = 100;
  };
  void report(const std::string& name, const Said& s) {
    folder_.write("reports/" + name + "/report.json",
                  fmt::format(R"({{"title": "{}", "mode": "{}", "began": "{}", "sim_seconds": {}, "fields": {},
"exercise": {{"state": "{}", "faults": [{{"count": {}}}]}},
"metrics": [{{"id": "path", "hand": "right", "unit": "mm", "value": {}}}]}})",
                              s.title, s.mode, name, s.seconds,
                              s.person.empty() ? "{}" : fmt::format(R"({{"person": "{}"}})", s.person), s.state,
                              s.faults, s.path));
  }
  OwnRuns find(const std::string& person = "", const std::string& except = "none") const {
    return own_runs(folder_.path() / "reports", "Clipping", person, folder_.path() / "reports" / except);
  }
  test_files::TempFolder folder_;
};

TEST_F(OwnRunsTest, TheBestHasReachedItsGoalsWithTheFewestFaults) {
  report("2026-01-01_a", {.seconds = 80, .faults = 1});
  report("2026-01-02_a", {.seconds = 90, .faults = 0});
  report("2026-01-03_a", {.seconds = 70, .faults = 0});
  report("2026-01-04_a", {.state = "failed", .seconds = 10, .faults = 0});
  const OwnRuns runs = find();
  EXPECT_EQ(runs.count, 4U);
  ASSERT_TRUE(runs.last && runs.best);
  EXPECT_EQ(runs.last->began, "2026-01-04_a");
  EXPECT_EQ(runs.best->began, "2026-01-03_a");
  EXPECT_EQ(find("", "2026-01-04_a").last->began, "2026-01-03_a") << "this run is not among them";
}

TEST_F(OwnRunsTest, OthersExercisesPersonsAndDemonstrationsDoNotCount) {
  report("1", {.title = "Rupture"});
  report("2", {.person = "P07"});
  report("3", {.mode = "demonstration"});
  folder_.write("reports/4/report.json", "{broken");
  folder_.write("reports/5/other.json", "{}");
  EXPECT_EQ(find().count, 0U);
  EXPECT_EQ(find("P07").count, 1U);
  EXPECT_EQ(own_runs(folder_.path() / "nowhere", "Clipping", "", {}).count, 0U);
}

TEST_F(OwnRunsTest, TheTableSaysWhatHasChanged) {
  report("1", {.seconds = 50, .faults = 2, .path = 200});
  const MetricValue path{"path", "Path", "Insula", right_hand, true, 150, "mm", 0, Better::low};
  OwnRun now;
  now.seconds = 40;
  const Review review = review_of({path}, {}, {}, find(), now);
  ASSERT_EQ(review.comparison.size(), 4U);
  EXPECT_EQ(review.comparison[2].change, 1) << "fewer faults";
  const std::string html = review_html(review);
  for (const char* part : {"1 earlier run of", "Path (right hand)", "✓ better", ">150 mm<", ">200 mm<", ">40.0 s<"})
    EXPECT_NE(html.find(part), std::string::npos) << part << " in " << html;
  EXPECT_EQ(review_html(review_of({path}, {}, {}, {}, now)), "");
  const auto json = review_json(review);
  EXPECT_EQ(json.at("earlier_runs"), 1);
  EXPECT_EQ(json.at("comparison")[3].at("last"), "200 mm");
}

}  // namespace
}  // namespace insula
