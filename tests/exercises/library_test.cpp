// SPDX-License-Identifier: GPL-3.0-or-later
// Every case of the library, as scenes/cases/library.json declares it. A further case needs no further test.
#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>

#include "tests/exercises/play_motion.h"
#include "tests/exercises/told_hints.h"
#include "tools/workbench/written_rates.h"

namespace insula {
namespace {
namespace fs = std::filesystem;

const fs::path cases = fs::path(INSULA_SOURCE_DIR) / "scenes/cases";

/// The folders with a case, in order.
std::vector<std::string> case_folders() {
  std::vector<std::string> out;
  for (const auto& entry : fs::directory_iterator(cases))
    if (fs::exists(entry.path() / "case.xml")) out.push_back(entry.path().filename().string());
  std::sort(out.begin(), out.end());
  return out;
}

class LibraryCase : public testing::TestWithParam<std::string> {
 protected:
  const fs::path scene = cases / GetParam() / "case.xml";
  nlohmann::json declared() const {
    const auto table = nlohmann::json::parse(std::ifstream(cases / "library.json"));
    for (const auto& one : table.at("cases"))
      if (one.at("name") == GetParam()) return one;
    ADD_FAILURE() << GetParam() << " is not in library.json";
    return {};
  }
  std::vector<std::string> branches() const {
    const nlohmann::json both = declared().at("branches");
    return {both.at("superior").at("name"), both.at("inferior").at("name")};
  }
};
INSTANTIATE_TEST_SUITE_P(All, LibraryCase, testing::ValuesIn(case_folders()),
                         [](const auto& one) { return one.param; });

TEST_P(LibraryCase, SteadyHandsCloseTheNeckFasterThanLife) {
  test::ToldHints told;
  std::optional<SceneWork> work;
  test::Played o = test::play_motion(scene, "steady", -1, [&](const Simulation& s) {
    if (!work) work = count_work(s);
    told.listener()(s);
  });
  ASSERT_TRUE(o.ran);
  told.expect_few();
  EXPECT_TRUE(o.finite);
  EXPECT_EQ(o.state, ExerciseState::done);
  EXPECT_EQ(o.events["clip_released"], declared().value("clips", 1));
  EXPECT_EQ(o.events["rupture"], 0);
  for (const auto& [id, count] : o.faults) EXPECT_EQ(count, 0) << id;
  EXPECT_LE(o.measures["grade"], 1);
  EXPECT_LT(o.measures["remnant_pct"], 20);
  for (const std::string& branch : branches()) EXPECT_GT(o.measures[branch + ".flow_pct"], 90) << branch;
  test::expect_gentle(o);
  EXPECT_LT(estimate(work.value(), server_core, 2).step_ms, 500 * work->h) << "leaves no room for haptics and page";
}

TEST_P(LibraryCase, TheOtherMotionFailsForTheDeclaredReason) {
  const nlohmann::json fails = declared().at("fails");
  test::Played o = test::play_motion(scene, fails.at("motion"));
  ASSERT_TRUE(o.ran);
  EXPECT_TRUE(o.finite);
  if (fails.contains("fault")) {
    EXPECT_GE(o.faults[fails["fault"]], 1) << fails["fault"];
  } else {
    EXPECT_EQ(o.state, ExerciseState::running);
    EXPECT_LT(o.goals.at(fails.at("open")), 0) << fails["open"];
    EXPECT_GE(o.measures["grade"], 2);
  }
}

TEST_P(LibraryCase, ItHasACardAndSaysHowItWasMade) {
  EXPECT_TRUE(fs::exists(cases / GetParam() / "case.jpg"));
  EXPECT_TRUE(fs::exists(cases / GetParam() / "README.md"));
  for (const char* fact : {"title", "text", "lesson", "sources"}) EXPECT_FALSE(declared().at(fact).empty()) << fact;
}

TEST(Library, EveryDeclaredCaseIsThere) {
  const std::vector<std::string> all = case_folders();
  const auto table = nlohmann::json::parse(std::ifstream(cases / "library.json"));
  EXPECT_EQ(table.at("cases").size(), all.size());
  for (const auto& one : table.at("cases"))
    EXPECT_EQ(std::count(all.begin(), all.end(), one.at("name")), 1) << one.at("name");
}

}  // namespace
}  // namespace insula
