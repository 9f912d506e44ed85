// SPDX-License-Identifier: GPL-3.0-or-later
#include "viewer/gateway/curriculum_api.h"

#include <gtest/gtest.h>

#include <fstream>

#include "core/testing/temp_folder.h"
#include "training/progress/certificate.h"
#include "training/progress/curriculum_json.h"
#include "viewer/gateway/learning_json.h"

namespace insula::gateway {
namespace {

namespace fs = std::filesystem;
using nlohmann::json;

Task task_with_goals(const std::string& id, TaskMode mode, int in_a_row) {
  Task t;
  t.id = id, t.title = "Title of " + id, t.scene = "a.xml", t.mode = mode;
  Gate gate;
  gate.text = "goals reached", gate.in_a_row = in_a_row;
  t.gates = {gate};
  return t;
}

Curriculum small_curriculum() {
  Curriculum c;
  c.title = "Small", c.content_hash = 0xfedcba9876543210ull;
  Module first, second;
  first.id = "m1", first.title = "One", first.tasks = {task_with_goals("t1", TaskMode::practice, 1)};
  second.id = "m2", second.title = "Two", second.needs = {"m1"},
  second.tasks = {task_with_goals("t2", TaskMode::test, 2)};
  second.tasks[0].seeds = {11, 12};
  c.modules = {first, second};
  return c;
}

class CurriculumApiTest : public testing::Test {
 protected:
  CurriculumApiTest() {
    store_.emplace(folder_.path() / "training.sqlite");
    training::Person person;
    person.pseudonym = "P07";
    store_->add(person);
  }

  fs::path file() const { return folder_.path() / "curricula.json"; }
  void write_list() const {
    const json list{
        {"version", "insula 1"},
        {"project", folder_.path()},
        {"scenes", {{"a.xml", {{"scene", "scenes/a.xml"}, {"title", "A"}}}}},
        {"curricula",
         {{{"id", "small"}, {"problem", ""}, {"curriculum", json(training::curriculum_json(small_curriculum()))}},
          {{"id", "bad"}, {"problem", "bad.xml:1: error"}, {"curriculum", nullptr}}}}};
    std::ofstream(file()) << list;
  }
  CurriculumApi api() {
    return {file(), [this] { ++wanted_; }};
  }
  std::string add_run(const char* mode, std::optional<std::int64_t> seed, std::int64_t began_ms) {
    training::Run run;
    run.uuid = training::new_uuid(), run.person = "P07", run.scene = "elsewhere/a.xml", run.mode = mode;
    run.state = "done", run.began_ms = began_ms, run.seed = seed;
    store_->add(run);
    return run.uuid;
  }
  json progress(CurriculumApi& a, const std::string& person = "P07") {
    return json::parse(a.progress(*store_, person).json);
  }

  test_files::TempFolder folder_;
  std::optional<training::Store> store_;
  int wanted_ = 0;
};

TEST_F(CurriculumApiTest, AsksForTheListOnceAPageWantsItAndSaysWhatIsWrong) {
  auto a = api();
  EXPECT_EQ(wanted_, 0);
  EXPECT_EQ(json::parse(a.list().json)["state"], "loading");
  EXPECT_GE(wanted_, 1);
  EXPECT_EQ(a.follow(*store_, json{{"person", "P07"}, {"curriculum", "small"}}).status, 503);
  write_list();
  const json list = json::parse(a.list().json);
  EXPECT_EQ(list["state"], "ready");
  ASSERT_EQ(list["curricula"].size(), 2u);
  EXPECT_EQ(list["curricula"][1]["problem"], "bad.xml:1: error");
  CurriculumApi none({}, [] { FAIL() << "there is no file to ask for"; });
  EXPECT_EQ(json::parse(none.list().json)["state"], "none");
}

TEST_F(CurriculumApiTest, AListThatIsBrokenIsRefused) {
  for (const char* bad :
       {"", "[]", "{}", R"({"problem":"it was killed"})",
        R"({"version":"","project":"","scenes":{},"curricula":[{"id":"x","problem":"","curriculum":{}}]})"}) {
    std::ofstream(file()) << bad;
    auto a = api();
    const json list = json::parse(a.list().json);
    EXPECT_EQ(list["state"], "refused") << bad;
    EXPECT_NE(list["problem"], "") << bad;
  }
}

TEST_F(CurriculumApiTest, APersonFollowsOneThatIsThere) {
  write_list();
  auto a = api();
  const auto follow = [&](const json& body) { return a.follow(*store_, body).status; };
  EXPECT_EQ(progress(a)["id"], "");
  EXPECT_EQ(follow({{"person", "P07"}}), 400);
  EXPECT_EQ(follow({{"person", "P07"}, {"curriculum", 7}}), 400);
  EXPECT_EQ(follow({{"person", "P07"}, {"curriculum", "none"}}), 404);
  EXPECT_EQ(follow({{"person", "P07"}, {"curriculum", "bad"}}), 404);
  EXPECT_EQ(follow({{"person", "P08"}, {"curriculum", "small"}}), 404);
  EXPECT_EQ(follow({{"person", ""}, {"curriculum", "small"}}), 404);
  EXPECT_EQ(follow({{"person", "P07"}, {"curriculum", "small"}}), 200);
  EXPECT_EQ(progress(a)["title"], "Small");
  EXPECT_EQ(progress(a, "")["id"], "") << "a guest follows none";
  EXPECT_EQ(follow({{"person", "P07"}, {"curriculum", ""}}), 200);
  EXPECT_EQ(progress(a)["id"], "");
  store_->follow("P07", "gone");
  EXPECT_EQ(a.progress(*store_, "P07").status, 404) << "its file was taken away";
}

TEST_F(CurriculumApiTest, LeadsToACertificateOverTheRunsThatCounted) {
  write_list();
  auto a = api();
  store_->follow("P07", "small");
  json p = progress(a);
  EXPECT_EQ(p["next"]["task"], "t1");
  EXPECT_EQ(p["next"]["exercise"], "scenes/a.xml");
  EXPECT_EQ(p["next"]["start"], "practice");
  EXPECT_EQ(p["modules"][1]["standing"], "locked");
  EXPECT_TRUE(a.has_scene("scenes/a.xml"));
  EXPECT_FALSE(a.has_scene("/etc/passwd"));

  const std::string first = add_run("practice", {}, 1000);
  p = progress(a);
  EXPECT_EQ(p["modules"][0]["tasks"][0]["runs"][0]["uuid"], first);
  EXPECT_EQ(p["next"]["task"], "t2");
  EXPECT_EQ(p["next"]["start"], "test");
  EXPECT_EQ(p["next"]["seed"], 11);
  add_run("practice", 11, 2000);
  EXPECT_EQ(progress(a)["modules"][1]["tasks"][0]["attempts"], 0) << "practice counts for no test";
  const std::string second = add_run("test", 11, 3000);
  EXPECT_EQ(progress(a)["next"]["seed"], 12);
  EXPECT_EQ(a.certificate(*store_, "P07", "small").status, 404) << "one of two in a row";
  const std::string third = add_run("test", 12, 4000);
  EXPECT_EQ(progress(a)["passed"], true);

  const auto answer = a.certificate(*store_, "P07", "small");
  ASSERT_EQ(answer.status, 200);
  const json c = json::parse(answer.json);
  EXPECT_EQ(c["version"], "insula 1");
  EXPECT_EQ(c["tasks"][1]["gates"][0]["kind"], "goals");
  EXPECT_EQ(c["tasks"][1]["gates"][0]["in_a_row"], 2);
  EXPECT_EQ(c["tasks"][1]["runs"].size(), 2u);
  EXPECT_EQ(c["began_ms"], 1000);
  EXPECT_EQ(c["passed_ms"], 4000);
  EXPECT_EQ(c["digest"], training::certificate_digest("P07", "fedcba9876543210", {third, second, first, first}));
  EXPECT_NE(c["digest"], training::certificate_digest("P07", "fedcba9876543210", {third, second}));
  EXPECT_EQ(a.certificate(*store_, "P08", "small").status, 404);
  EXPECT_EQ(a.certificate(*store_, "P07", "none").status, 404);
}

TEST_F(CurriculumApiTest, KnowsTheLevelOfAMetricFromACurriculumOrFromSpecialists) {
  Curriculum c = small_curriculum();
  Gate gate;
  gate.kind = Gate::Kind::metric, gate.metric = "path", gate.hand = "left", gate.at_most = 9, gate.in_a_row = 2;
  c.modules[1].tasks[0].gates.push_back(gate);
  std::ofstream(file()) << json{
      {"version", ""},
      {"project", folder_.path()},
      {"scenes", {{"a.xml", {{"scene", "scenes/a.xml"}, {"title", "A"}}}}},
      {"curricula", {{{"id", "c"}, {"problem", ""}, {"curriculum", json(training::curriculum_json(c))}}}}};
  auto a = api();
  const Gate* found = a.metric_gate("scenes/a.xml", "path", "left", "");
  ASSERT_TRUE(found);
  EXPECT_EQ(a.metric_gate("scenes/a.xml", "path", "right", ""), nullptr);
  EXPECT_EQ(a.metric_gate("scenes/b.xml", "path", "left", ""), nullptr);

  training::LearningCurve curve;
  curve.metric = {"path", "left", 0, "Path", "mm", "low", 1};
  const auto point = [&](double value, bool done) { curve.points.push_back({"", 0, "practice", done, value}); };
  point(12, true), point(3, false), point(8, true), point(9, true);
  const json with = json(curve_json(curve, level_of(*found)));
  EXPECT_EQ(with["attempts_to_level"], 4) << "what misses a goal fails, however short its path was";
  EXPECT_EQ(with["cusum"]["sum"].size(), 4u);
  EXPECT_GT(with["cusum"]["sum"][1], with["cusum"]["sum"][0]);
  EXPECT_LT(with["cusum"]["sum"][2], with["cusum"]["sum"][1]);
  EXPECT_FALSE(json(curve_json(curve, std::nullopt)).contains("level"));

  EXPECT_FALSE(level_of_specialists(*store_, "s.xml", curve.metric));
  training::Person expert;
  expert.pseudonym = "E1", expert.role = "specialist";
  store_->add(expert);
  for (int i = 1; i <= 6; ++i) {
    training::Run run;
    run.uuid = training::new_uuid(), run.person = i == 6 ? "P07" : "E1", run.scene = "s.xml", run.mode = "practice";
    run.state = "done", run.metrics = {{"path", "left", i * 10.0, "Path", "mm", "low", 1}};
    store_->add(run);
  }
  const auto level = level_of_specialists(*store_, "s.xml", curve.metric);
  ASSERT_TRUE(level);
  EXPECT_EQ(level->at_most, 30) << "the median of 10 to 50; P07 is no specialist";
  EXPECT_FALSE(level->at_least);
}

/// printf 'P07\n1\na\nb\n' | sha256sum
TEST(CertificateDigest, IsThatOfOtherPrograms) {
  EXPECT_EQ(training::certificate_digest("P07", "1", {"b", "a"}), "7753-9772-184f-f513");
}

}  // namespace
}  // namespace insula::gateway
