// SPDX-License-Identifier: GPL-3.0-or-later
// The example of an exercise ends live, with all its processes and in real time, as it ends headless: the same steps.
#include <cstdlib>
#include <nlohmann/json.hpp>

#include "tests/process/play_session.h"

namespace insula::testing {
namespace {

using Json = nlohmann::json;

/// The first report in a folder or in one of its subfolders; null while there is none.
Json report_below(const fs::path& folder) {
  std::error_code none;
  for (const auto& entry : fs::recursive_directory_iterator(folder, none))
    if (entry.path().filename() == "report.html" && fs::is_regular_file(entry.path().parent_path() / "report.json")) {
      std::ifstream in(entry.path().parent_path() / "report.json");
      return Json::parse(in, nullptr, false);
    }
  return {};
}

struct Shipped {
  const char* scene;
  std::size_t measures;  ///< at least
};
const Shipped exercises[] = {
    {"1_sylvian_fissure", 2}, {"2_aneurysm_dissection", 1}, {"3_clipping", 9}, {"4_rupture", 9}};
void PrintTo(const Shipped& e, std::ostream* out) { *out << e.scene; }

/// The live report is of the exercise's end, the other one of the motion's. Counts and grades have settled by then.
double tolerance(const Json& measure) {
  const std::string unit = measure.at("unit");
  const double least = unit == "%" ? 2 : unit == "mm" ? 0.2 : 0;
  return unit.empty() ? 0 : std::max(least, 0.05 * std::abs(measure.at("value").get<double>()));
}

void expect_same_end(const Json& live, const Json& headless, const Shipped& exercise) {
  EXPECT_EQ(live.at("state"), headless.at("state"));
  ASSERT_EQ(live.at("goals").size(), headless.at("goals").size());
  for (std::size_t i = 0; i < live.at("goals").size(); ++i) {
    const Json &a = live.at("goals")[i], &b = headless.at("goals")[i];
    EXPECT_EQ(a.at("id"), b.at("id"));
    EXPECT_EQ(a.at("done"), b.at("done")) << a.at("id");
    if (a.at("done") && b.at("done")) {
      EXPECT_DOUBLE_EQ(a.at("time_s").get<double>(), b.at("time_s").get<double>()) << a.at("id");
    }
  }
  ASSERT_EQ(live.at("faults").size(), headless.at("faults").size());
  for (std::size_t i = 0; i < live.at("faults").size(); ++i)
    EXPECT_EQ(live.at("faults")[i].at("count"), headless.at("faults")[i].at("count")) << live.at("faults")[i].at("id");
  ASSERT_EQ(live.at("measures").size(), headless.at("measures").size());
  EXPECT_GE(live.at("measures").size(), exercise.measures);
  for (std::size_t i = 0; i < live.at("measures").size(); ++i) {
    const Json &a = live.at("measures")[i], &b = headless.at("measures")[i];
    EXPECT_EQ(a.at("id"), b.at("id"));
    EXPECT_NEAR(a.at("value").get<double>(), b.at("value").get<double>(), tolerance(b)) << a.at("id");
  }
}

class Example : public ::testing::TestWithParam<Shipped> {};

TEST_P(Example, EndsLiveAsItDoesHeadless) {
  if (!multicast_works()) GTEST_SKIP() << "no multicast on this machine";
  const fs::path scene = fs::path(INSULA_SOURCE_DIR) / "scenes/training" / (std::string(GetParam().scene) + ".xml");
  PlaySession session;
  ASSERT_EQ(session.start({"--report", (session.folder() / "live").string(), "--motion", "steady"}, scene), "");
  const std::string run = std::string(INSULA_BINARY_DIR) + "/bin/insula run " + scene.string() +
                          " --motion steady --quiet --report " + (session.folder() / "headless").string() +
                          " > /dev/null";
  ASSERT_EQ(std::system(run.c_str()), 0);
  const Json headless = report_below(session.folder() / "headless");
  ASSERT_TRUE(headless.is_object());
  Json live;
  const auto ended = [&] {
    live = report_below(session.folder() / "live");
    return live.is_object();
  };
  for (int k = 0; k < 20 && !wait_for(ended); ++k) {
  }
  ASSERT_TRUE(live.is_object()) << "no report of the live example\n" << session.log();
  expect_same_end(live.at("exercise"), headless.at("exercise"), GetParam());
  EXPECT_EQ(live.at("motion"), "steady");
}

INSTANTIATE_TEST_SUITE_P(Exercises, Example, ::testing::ValuesIn(exercises),
                         [](const auto& info) { return std::string(info.param.scene).substr(2); });

}  // namespace
}  // namespace insula::testing
