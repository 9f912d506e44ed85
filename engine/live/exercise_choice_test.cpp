// SPDX-License-Identifier: GPL-3.0-or-later
// Another exercise in a running session, and the list of exercises that pages choose from.
#include "engine/live/exercise_choice.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <fstream>
#include <nlohmann/json.hpp>
#include <utility>

#include "core/testing/block_mesh.h"
#include "engine/command_line/run.h"
#include "engine/live/catalogue.h"
#include "engine/live/project_folder.h"

namespace insula {
namespace {

namespace fs = std::filesystem;
using nlohmann::json;

class ExerciseChoiceTest : public testing::Test {
 protected:
  fs::path state_file() const { return folder_.path() / "choice.json"; }
  json state() const {
    std::ifstream in(state_file());
    return json::parse(in);
  }
  /// A session in which a page asks once. Returns its lines.
  std::vector<std::string> session(ExerciseChoice& choice, const char* request, double duration_s) const {
    std::vector<std::string> lines;
    Supervisor* running = nullptr;
    SupervisorSettings settings;
    settings.look_s = 0.01, settings.duration_s = duration_s, settings.first_wait_s = 0.05;
    bool asked = false;
    settings.look = [&] {
      if (!std::exchange(asked, true)) {
        choice.ask(request);
        EXPECT_EQ(state()["state"], "loading");
      }
      choice.look(*running);
    };
    Supervisor supervisor(settings, [&](std::string_view line) { lines.emplace_back(line); });
    running = &supervisor;
    ChildSpec engine;
    engine.name = "engine";
    engine.command = {"/bin/sh", "-c", "while :; do sleep 0.01; done"};
    supervisor.add(engine);
    EXPECT_EQ(supervisor.run(), 0);
    return lines;
  }

  test::SceneFolder folder_;
};

/// Two "engines": shells that print the line, and one that is killed after it has taken over.
TEST_F(ExerciseChoiceTest, TakesOverTellsPagesAndSurvivesTheDeathOfTheNewEngine) {
  const fs::path died = folder_.path() / "died";
  const auto command = [&](const ChosenExercise& c) {
    const std::string dies = "[ -e " + died.string() + " ] || { touch " + died.string() + "; exit 9; }; ";
    return std::vector<std::string>{"/bin/sh", "-c",
                                    std::string("echo '") + standby_line +
                                        "'; trap 'trap - USR1; echo go' USR1; echo now " + c.scene + " " + c.person +
                                        "; sleep 0.5; " + dies + "while :; do sleep 0.01; done"};
  };
  std::vector<std::string> taken;
  ExerciseChoice choice({"a.xml", ""}, state_file(), command,
                        [&](const ChosenExercise& c) { taken.push_back(c.scene + " " + c.person); });
  EXPECT_EQ(state()["state"], "running");
  EXPECT_EQ(state()["scene"], "a.xml");
  for (const char* bad : {"", "[]", R"({"scene":"b.xml"})", R"({"scene":1,"person":""})"}) choice.ask(bad);
  EXPECT_EQ(state()["scene"], "a.xml") << "what is no request changes nothing";

  const auto lines = session(choice, R"({"scene":"b.xml","person":"P07"})", 3);
  EXPECT_EQ(taken, std::vector<std::string>{"b.xml P07"});
  EXPECT_EQ(state()["state"], "running");
  EXPECT_EQ(state()["person"], "P07");
  EXPECT_GE(std::count(lines.begin(), lines.end(), "[engine] now b.xml P07"), 2)
      << "the engine that is started again has the chosen exercise";
}

TEST_F(ExerciseChoiceTest, ModeAndSeedAreTakenWhenTheyAreWhole) {
  const auto read = read_choice(R"({"scene":"b.xml","person":"P07","mode":"test","seed":21,"request":"r1"})");
  ASSERT_TRUE(read);
  EXPECT_EQ(read->mode, "test");
  EXPECT_EQ(read->seed, 21u);
  EXPECT_EQ(json::parse(state_json(*read, "running", ""))["request"], "r1");
  EXPECT_FALSE(read_choice(R"({"scene":"b.xml","person":""})")->seed);
  for (const char* bad : {R"("mode":"demonstration")", R"("mode":"waiting")", R"("mode":1)", R"("seed":0)",
                          R"("seed":-1)", R"("seed":1.5)", R"("seed":"7")", R"("seed":2147483648)", R"("request":7)"})
    EXPECT_FALSE(read_choice(std::string(R"({"scene":"b.xml","person":"",)") + bad + "}")) << bad;
}

TEST_F(ExerciseChoiceTest, ARefusedSceneLeavesTheOldOneAndSaysWhy) {
  ExerciseChoice choice(
      {"a.xml", ""}, state_file(),
      [](const ChosenExercise&) {
        return std::vector<std::string>{"/bin/sh", "-c", "echo 'b.xml:1:2: error: wrong'; exit 2"};
      },
      [](const ChosenExercise&) { FAIL() << "it was not taken"; });
  session(choice, R"({"scene":"b.xml","person":""})", 0.6);
  EXPECT_EQ(state()["state"], "refused");
  EXPECT_EQ(state()["text"], "b.xml:1:2: error: wrong\n");
}

TEST_F(ExerciseChoiceTest, TheCatalogueHasScenesWithAnExercise) {
  folder_.write("scenes/training/2_b.xml", R"(<scene title="B"><exercise id="e" text="Do &lt;it&gt;"/></scene>)");
  folder_.write("scenes/training/2_b.jpg", "picture");
  folder_.write("scenes/training/1_a.xml", R"(<scene><exercise id="e" title="A"/></scene>)");
  folder_.write("scenes/training/motion.csv", "");
  folder_.write("scenes/training/broken.xml", "<scene><exercise");
  folder_.write("scenes/parts/c.xml", R"(<part><exercise id="e"/></part>)");
  folder_.write("scenes/cases/mine/3_c.xml",
                R"(<scene title="C"><exercise id="e" title="D" site="middle cerebral" difficulty="4"/></scene>)");
  folder_.write("scenes/cases/alone.xml", R"(<scene title="E"><exercise/></scene>)");
  folder_.write("scenes/cases/bench.xml", R"(<scene title="No exercise"/>)");
  const auto found = catalogue(folder_.path());
  ASSERT_EQ(found.size(), 4u);
  EXPECT_EQ(found[0].scene, "scenes/training/1_a.xml");
  EXPECT_EQ(found[0].title, "A");
  EXPECT_EQ(found[0].picture, "");
  EXPECT_EQ(found[1].text, "Do <it>");
  EXPECT_EQ(found[1].picture, (folder_.path() / "scenes/training/2_b.jpg").string());
  EXPECT_EQ(found[2].group, "cases");
  EXPECT_EQ(found[2].scene, "scenes/cases/alone.xml");
  EXPECT_EQ(found[2].of_case, "");
  EXPECT_EQ(found[3].of_case, "mine");
  EXPECT_EQ(found[3].id, "e");
  EXPECT_EQ(found[3].name, "D");
  EXPECT_EQ(found[3].title, "C");
  EXPECT_EQ(found[3].site, "middle cerebral");
  EXPECT_EQ(found[3].difficulty, 4);
  EXPECT_EQ(found[1].difficulty, 0) << "not said";
  EXPECT_TRUE(catalogue(folder_.path() / "nowhere").empty());
}

TEST_F(ExerciseChoiceTest, SceneNamesAreThoseBelowTheProject) {
  EXPECT_EQ(scene_name("scenes/training/../training/3_clipping.xml"), "scenes/training/3_clipping.xml");
  EXPECT_EQ(scene_name(fs::absolute("scenes/training/3_clipping.xml")), "scenes/training/3_clipping.xml");
  EXPECT_EQ(scene_name("/elsewhere/x.xml"), "/elsewhere/x.xml");
  EXPECT_EQ(scene_file("/elsewhere/x.xml"), "/elsewhere/x.xml");
  EXPECT_TRUE(fs::is_regular_file(scene_file("scenes/training/3_clipping.xml")));
}

}  // namespace
}  // namespace insula
