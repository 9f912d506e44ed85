// SPDX-License-Identifier: GPL-3.0-or-later
#include "viewer/gateway/training_api.h"

#include <gtest/gtest.h>

#include "core/testing/temp_folder.h"

namespace insula::gateway {
namespace {

namespace fs = std::filesystem;
using nlohmann::json;

class TrainingApiTest : public testing::Test {
 protected:
  TrainingApiTest() {
    folder_.write("catalogue.json",
                  R"([{"scene":"scenes/a b/1.xml","group":"training","title":"One","text":"Do.","picture":"/p/1.jpg"},
               {"scene":"2.xml","group":"cases","title":"Two","text":"","picture":""}, {"scene":7}, "x"])");
    folder_.write("choice.json", R"({"scene":"2.xml","person":"","state":"running","text":""})");
  }

  TrainingApi api(const fs::path& store) {
    return {{store, folder_.path() / "catalogue.json", folder_.path() / "choice.json"},
            {[this](const std::string& j) { chosen_.push_back(json::parse(j)); }, {}}};
  }

  test_files::TempFolder folder_;
  std::vector<json> chosen_;
};

TEST_F(TrainingApiTest, ListsExercisesWithoutTheirPaths) {
  auto a = api({});
  const json list = json::parse(a.get("exercises", "").json);
  ASSERT_EQ(list.size(), 2u) << "what is no exercise is left out";
  EXPECT_EQ(list[0]["picture"], true);
  EXPECT_EQ(list[1]["picture"], false);
  EXPECT_EQ(a.picture("scenes/a b/1.xml"), "/p/1.jpg");
  EXPECT_EQ(a.picture("2.xml"), "");
  EXPECT_EQ(a.picture("/etc/passwd"), "");
  EXPECT_EQ(json::parse(a.get("state", "").json)["scene"], "2.xml");
  EXPECT_EQ(a.get("nothing", "").status, 404);
}

TEST_F(TrainingApiTest, AddsPersonsAndSaysWhatIsWrong) {
  auto a = api(folder_.path() / "training.sqlite");
  EXPECT_EQ(a.post("people", R"({"pseudonym":"P07","role":"resident","handedness":"left","year":3})").status, 200);
  const auto again = a.post("people", R"({"pseudonym":"p07"})");
  EXPECT_EQ(again.status, 400);
  EXPECT_EQ(json::parse(again.json)["error"], "the pseudonym \"p07\" is in use");
  for (const char* bad : {"", "[]", "{}", R"({"pseudonym":7})", R"({"pseudonym":"a","role":"king"})",
                          R"({"pseudonym":"a","year":"three"})", R"({"pseudonym":"a","year":1e300})",
                          R"({"pseudonym":"a","year":9000000000000000000})"})
    EXPECT_EQ(a.post("people", bad).status, 400) << bad;
  const json people = json::parse(a.get("people", "").json);
  ASSERT_EQ(people.size(), 1u);
  EXPECT_EQ(people[0]["year"], 3);
}

TEST_F(TrainingApiTest, TellsRunsOfTheOneWhoIsAskedFor) {
  auto a = api(folder_.path() / "training.sqlite");
  training::Store store(folder_.path() / "training.sqlite");
  training::Run run;
  run.uuid = training::new_uuid(), run.person = "Käthe 9", run.scene = "scenes/a b/1.xml", run.title = "One";
  run.mode = "practice", run.state = "done", run.began_ms = 5, run.recording = "/folder/of/mine/night.insula";
  run.metrics = {{"path", "left", 7, "Path", "mm", "low", 1}};
  store.add(run);
  const json history = json::parse(a.get("history", "person=K%C3%A4the%209").json);
  ASSERT_EQ(history.size(), 1u);
  EXPECT_EQ(history[0]["best"]["state"], "done");
  EXPECT_EQ(history[0]["last"]["recording"], "night") << "no path leaves the machine";
  EXPECT_EQ(json::parse(a.get("history", "").json).size(), 0u) << "guests have not run";
  const json curves = json::parse(a.get("curves", "scene=scenes%2Fa%20b%2F1.xml&person=K%C3%A4the%209").json);
  ASSERT_EQ(curves.size(), 1u);
  EXPECT_EQ(curves[0]["points"][0]["value"], 7);
  EXPECT_EQ(json::parse(a.get("run", "uuid=" + run.uuid).json)["metrics"][0]["id"], "path");
  EXPECT_EQ(a.get("run", "uuid=x").status, 404);
  EXPECT_EQ(json::parse(a.get("runs", "person=nobody").json).size(), 0u);
}

TEST_F(TrainingApiTest, PassesOnChoicesOfWhatThereIsOnly) {
  auto a = api(folder_.path() / "training.sqlite");
  a.post("people", R"({"pseudonym":"P07"})");
  EXPECT_EQ(a.post("choose", R"({"scene":"2.xml","person":"P07"})").status, 202);
  EXPECT_EQ(a.post("choose", R"({"scene":"2.xml","person":""})").status, 202);
  EXPECT_EQ(a.post("choose", R"({"scene":"/etc/passwd","person":""})").status, 404);
  EXPECT_EQ(a.post("choose", R"({"scene":"2.xml","person":"P08"})").status, 404);
  EXPECT_EQ(a.post("choose", R"({"scene":["2.xml"]})").status, 404);
  ASSERT_EQ(chosen_.size(), 2u);
  EXPECT_EQ(chosen_[0], (json{{"scene", "2.xml"}, {"person", "P07"}}));
}

TEST_F(TrainingApiTest, ChecksTheTermsOfAnAttempt) {
  auto a = api({});
  EXPECT_EQ(a.post("choose", R"({"scene":"2.xml","person":"","mode":"test","seed":7,"request":"r"})").status, 202);
  EXPECT_EQ(chosen_.back(),
            (json{{"scene", "2.xml"}, {"person", ""}, {"mode", "test"}, {"seed", 7}, {"request", "r"}}));
  for (const char* bad : {R"("mode":"demonstration")", R"("mode":7)", R"("seed":0)", R"("seed":-3)", R"("seed":1.5)",
                          R"("seed":2147483648)", R"("seed":"7")", R"("request":7)"})
    EXPECT_EQ(a.post("choose", std::string(R"({"scene":"2.xml","person":"",)") + bad + "}").status, 400) << bad;
  const std::string long_name(65, 'r');
  EXPECT_EQ(a.post("choose", R"({"scene":"2.xml","person":"","request":")" + long_name + "\"}").status, 400);
  EXPECT_EQ(chosen_.size(), 1u);
}

TEST_F(TrainingApiTest, WithoutAStoreThereAreGuestsOnly) {
  auto a = api({});
  EXPECT_EQ(a.get("people", "").json, "[]\n");
  EXPECT_EQ(a.get("history", "person=").json, "[]\n");
  EXPECT_EQ(a.post("people", R"({"pseudonym":"P07"})").status, 503);
  EXPECT_EQ(a.post("choose", R"({"scene":"2.xml","person":""})").status, 202);
  auto broken = api("/proc/nowhere/t.sqlite");
  EXPECT_EQ(broken.get("people", "").status, 503);
}

TEST(QueryValue, IsDecodedAndFoundByItsWholeName) {
  EXPECT_EQ(query_value("a=1&bc=%C3%A4%2F", "bc"), "ä/");
  EXPECT_EQ(query_value("abc=1&b=2", "b"), "2");
  EXPECT_EQ(query_value("b", "b"), "");
  EXPECT_EQ(query_value("b=%zz", "b"), "");
  EXPECT_EQ(query_value("", "b"), "");
}

}  // namespace
}  // namespace insula::gateway
