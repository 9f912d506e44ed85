// SPDX-License-Identifier: GPL-3.0-or-later
// Every case of the library with all its exercises, as scenes/cases/library.json declares them. A further case or
// exercise needs no further test.
#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>

#include "engine/live/catalogue.h"
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

const nlohmann::json& library() {
  static const auto table = nlohmann::json::parse(std::ifstream(cases / "library.json"));
  return table.at("cases");
}

nlohmann::json declared_case(const std::string& name) {
  for (const auto& one : library())
    if (one.at("name") == name) return one;
  ADD_FAILURE() << name << " is not in library.json";
  return {};
}

std::vector<std::string> branches_of(const nlohmann::json& one) {
  const nlohmann::json both = one.at("branches");
  return {both.at("superior").at("name"), both.at("inferior").at("name")};
}

/// The declared fault, or the declared goal that stays open.
void expect_failure(test::Played& o, const nlohmann::json& fails) {
  ASSERT_TRUE(o.ran);
  EXPECT_TRUE(o.finite);
  if (fails.contains("fault")) {
    EXPECT_GE(o.faults[fails["fault"]], 1) << fails["fault"];
  } else {
    EXPECT_NE(o.state, ExerciseState::done);
    EXPECT_LT(o.goals.at(fails.at("open")), 0) << fails["open"];
  }
}

class LibraryCase : public testing::TestWithParam<std::string> {
 protected:
  const fs::path scene = cases / GetParam() / "case.xml";
  nlohmann::json declared() const { return declared_case(GetParam()); }
  std::vector<std::string> branches() const { return branches_of(declared()); }
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
  test::ToldHints told;
  test::Played o = test::play_motion(scene, fails.at("motion"), -1, told.listener());
  expect_failure(o, fails);
  if (fails.contains("hint")) {
    EXPECT_TRUE(told.first_cue.contains(fails["hint"])) << fails["hint"] << " was not told";
  }
  if (fails.contains("fault")) return;
  EXPECT_EQ(o.state, ExerciseState::running);
  EXPECT_GE(o.measures["grade"], 2);
}

TEST_P(LibraryCase, ItHasACardAndSaysHowItWasMade) {
  EXPECT_TRUE(fs::exists(cases / GetParam() / "case.jpg"));
  EXPECT_TRUE(fs::exists(cases / GetParam() / "README.md"));
  for (const char* fact : {"title", "text", "lesson", "sources"}) EXPECT_FALSE(declared().at(fact).empty()) << fact;
}

TEST(Library, EveryDeclaredCaseIsThere) {
  const std::vector<std::string> all = case_folders();
  EXPECT_EQ(library().size(), all.size());
  for (const auto& one : library()) EXPECT_EQ(std::count(all.begin(), all.end(), one.at("name")), 1) << one.at("name");
}

/// An exercise of a case beside clipping.
struct Further {
  std::string of_case, id;
  friend void PrintTo(const Further& f, std::ostream* out) { *out << f.of_case << ", " << f.id; }
};

std::vector<Further> further_exercises() {
  std::vector<Further> out;
  for (const auto& one : library())
    for (const auto& more : one.value("exercises", nlohmann::json::array()))
      out.push_back({one.at("name"), more.at("id")});
  return out;
}

/// It must say what the trainee does and learns, and lie in its folder. Nothing else there may be an exercise.
TEST(Library, TheExercisesOfACaseAreThoseThatItDeclares) {
  for (const std::string& name : case_folders()) {
    std::vector<std::string> files{"case.xml"};
    for (const auto& more : declared_case(name).value("exercises", nlohmann::json::array())) {
      files.push_back(more.at("id").get<std::string>() + ".xml");
      for (const char* fact : {"title", "text", "lesson"}) EXPECT_FALSE(more.at(fact).empty()) << name << fact;
    }
    std::vector<std::string> found;
    for (const CatalogueEntry& e : catalogue(INSULA_SOURCE_DIR))
      if (e.of_case == name) found.push_back(fs::path(e.scene).filename());
    std::sort(files.begin(), files.end());
    EXPECT_EQ(found, files) << name;
    std::ifstream readme(cases / name / "README.md");
    const std::string text{std::istreambuf_iterator<char>(readme), {}};
    for (const std::string& file : files) EXPECT_NE(text.find("`" + file + "`"), std::string::npos) << name << file;
  }
}

class LibraryExercise : public testing::TestWithParam<Further> {
 protected:
  const fs::path scene = cases / GetParam().of_case / (GetParam().id + ".xml");
  nlohmann::json declared() const {
    const nlohmann::json one = declared_case(GetParam().of_case);
    for (const auto& more : one.at("exercises"))
      if (more.at("id") == GetParam().id) return more;
    ADD_FAILURE() << GetParam().id << " is not among the exercises of " << GetParam().of_case;
    return {};
  }
};
INSTANTIATE_TEST_SUITE_P(All, LibraryExercise, testing::ValuesIn(further_exercises()),
                         [](const auto& one) { return one.param.of_case + "_" + one.param.id; });

TEST_P(LibraryExercise, SteadyHandsMasterIt) {
  test::ToldHints told;
  double lumen = 1;  // least one of the parent over that at rest
  test::Played o = test::play_motion(scene, "steady", -1, [&](const Simulation& s) {
    lumen = std::min(lumen, s.channel("flow.parent.lumen"));
    told.listener()(s);
  });
  ASSERT_TRUE(o.ran);
  told.expect_few();
  EXPECT_TRUE(o.finite);
  EXPECT_EQ(o.state, ExerciseState::done);
  for (const auto& [id, time] : o.goals) EXPECT_GT(time, 0) << id;
  for (const auto& [id, count] : o.faults) EXPECT_EQ(count, 0) << id;
  EXPECT_LE(o.measures["grade"], 1);
  EXPECT_LT(o.measures["remnant_pct"], 25);
  for (const std::string& branch : branches_of(declared_case(GetParam().of_case)))
    EXPECT_GT(o.measures[branch + ".flow_pct"], 90) << branch;
  const double most = declared().contains("temporary") ? 0.1 : 1.0;
  EXPECT_LE(lumen, most) << "the temporary clip does not shut the parent";
  test::expect_gentle(o);
}

TEST_P(LibraryExercise, TheOtherMotionFailsForTheDeclaredReason) {
  const nlohmann::json fails = declared().at("fails");
  test::Played o = test::play_motion(scene, fails.at("motion"));
  expect_failure(o, fails);
}

}  // namespace
}  // namespace insula
