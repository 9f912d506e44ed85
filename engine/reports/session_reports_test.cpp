// SPDX-License-Identifier: GPL-3.0-or-later
// A session as people play it writes a report at the exercise's end, before a reset and at its own end, each into a new
// folder.
#include "engine/reports/session_reports.h"

#include <algorithm>
#include <fstream>
#include <map>
#include <regex>

#include "core/base/input_error.h"
#include "core/container/mcap_reader.h"
#include "engine/live/engine_for_test.h"
#include "engine/session/session_format.h"
#include "training/store/store.h"

namespace insula {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::json;

/// Its goal is reached after so many seconds, and `again` asks for so many more.
class ReachedAt final : public ExerciseRule {
 public:
  Param<Duration> at{this, {.name = "at", .doc = "for tests"}};
  void declare(PrepareContext&, const Simulation&, ExerciseLog& log) override {
    goal_ = log.add_goal("there", "Be there");
  }
  void observe(const StepReport& report, ExerciseLog& log) override {
    if (asked_) {
      asked_ = false;
      from_ = report.time;
      log.reopen(report.time);
      log.goal_lost(goal_, report.time);
    }
    if (report.time > from_ + at() - 1e-9) log.goal(goal_, report.time);
  }
  std::vector<CommandInfo> commands() const override { return {{"again", "for tests", "", 0, 0}}; }
  std::string run_command(std::string_view, std::string_view) override {
    asked_ = true;
    return {};
  }
  void reset() override {
    asked_ = false;
    from_ = 0;
  }

 private:
  int goal_ = 0;
  bool asked_ = false;
  double from_ = 0;  ///< s
};

class SessionReportsTest : public testing::Test, public test::EngineInStep {
 protected:
  SessionReportsTest() { registry_.add<ReachedAt>("reached_at", Kind::exercise_rule, "for tests"); }

  /// A session of so many simulated seconds since its last reset, by steps of 10 ms; the exercise's goal is reached at
  /// `end`.
  int play(double duration_s, double end_s) {
    std::ostringstream scene;
    scene << R"(<scene title="Press" time_step="10 ms"><exercise id="e" title="Waiting"><reached_at id="r" at=")"
          << end_s << R"( s"/></exercise></scene>)";
    LiveOptions settings = options(folder_.write("press.xml", scene.str()), duration_s);
    settings.report = root();
    settings.record = record_;
    settings.store = store_;
    settings.fields = fields_;
    settings.mode = SessionMode::practice;
    return run(settings);
  }
  void hand_force(double newtons) {
    insula_lcm::hand_state_t hand = connected_hand(1, "mouse");
    hand.force_N[2] = -newtons;
    send_hand(hand);
  }
  /// In the order they were made.
  std::vector<Json> reports() const {
    std::vector<fs::path> folders;
    for (const auto& entry : fs::directory_iterator(root())) folders.push_back(entry.path());
    std::sort(folders.begin(), folders.end(), [](const auto& a, const auto& b) {
      return std::pair(a.string().size(), a) < std::pair(b.string().size(), b);
    });
    std::vector<Json> out;
    for (const fs::path& f : folders) {
      EXPECT_TRUE(std::regex_match(f.filename().string(), std::regex(R"(\d{4}-\d\d-\d\d_\d\d-\d\d-\d\d_press(_\d+)?)")))
          << f;
      EXPECT_TRUE(fs::is_regular_file(f / "report.html"));
      EXPECT_GT(fs::file_size(f / "report.html"), 1000u);
      std::ifstream in(f / "report.json");
      out.push_back(Json::parse(in));
    }
    return out;
  }
  fs::path root() const { return folder_.path() / "reports"; }

  fs::path record_, store_;
  std::map<std::string, std::string> fields_;
};

TEST_F(SessionReportsTest, EndsWithTheExercise) {
  ASSERT_EQ(play(0.5, 0.2), 0);
  EXPECT_EQ(steps_, 49) << "the session went on";
  const auto all = reports();
  ASSERT_EQ(all.size(), 1u) << "and wrote no other at its end";
  EXPECT_EQ(all[0].at("steps"), 20);
  EXPECT_NEAR(all[0].at("step_rate_hz").get<double>(), 100, 1e-9);
  EXPECT_NEAR(all[0].at("sim_seconds").get<double>(), 0.2, 1e-6);
  EXPECT_EQ(all[0].at("title"), "Press");
  EXPECT_EQ(all[0].at("exercise").at("state"), "done");
  EXPECT_EQ(all[0].at("exercise").at("goals").at(0).at("done"), true);
  EXPECT_EQ(all[0].at("events").back().at("kind"), "end");
  EXPECT_EQ(all[0].at("began").get<std::string>().size(), 19u);
}

TEST_F(SessionReportsTest, EachRunIsKeptInTheTrainingStore) {
  store_ = folder_.path() / "training.sqlite";
  fields_ = {{"person", "P07"}};
  on_step_ = [this](int step) {
    if (step == 20) ask("reset");
  };
  ASSERT_EQ(play(0.4, 0.3), 0);
  const training::Store store(store_);
  const auto runs = store.runs("P07");
  ASSERT_EQ(runs.size(), 2u);
  EXPECT_EQ(runs[0].state, "done");
  EXPECT_EQ(runs[1].state, "running") << "left before its end";
  EXPECT_EQ(runs[1].title, "Waiting");
  EXPECT_EQ(runs[1].mode, "practice");
  EXPECT_EQ(runs[0].goals_done, 1);
  EXPECT_EQ(runs[1].goals_done, 0);
  EXPECT_EQ(runs[1].scene, (fs::canonical(folder_.path()) / "press.xml").string());
  EXPECT_FALSE(runs[0].guided) << "the exercise has no guide";
  EXPECT_FALSE(runs[0].seed) << "nor complications";
  EXPECT_NEAR(runs[0].duration_s, 0.3, 1e-6);
  EXPECT_TRUE(fs::is_regular_file(runs[0].report));
  const auto all = reports();
  ASSERT_EQ(all.size(), 2u);
  const auto metrics = all[0].at("metrics").size();
  EXPECT_EQ(store.run(runs[1].uuid)->metrics.size(), metrics);
}

TEST_F(SessionReportsTest, AReopenedExerciseHasAnotherReport) {
  on_step_ = [this](int step) {
    if (step == 40) ask("ask", "r again");
  };
  ASSERT_EQ(play(1, 0.2), 0);
  const auto all = reports();
  ASSERT_EQ(all.size(), 2u);
  for (const Json& report : all) EXPECT_EQ(report.at("exercise").at("state"), "done");
  EXPECT_EQ(all[1].at("steps"), 21) << "from the request to the second end";
  EXPECT_EQ(all[1].at("events").at(1).at("kind"), "reopened");
}

TEST_F(SessionReportsTest, AResetBeginsAnotherAndTheEndOfTheSessionTheLast) {
  on_step_ = [this](int step) {
    if (step == 5) ask("ask", "nobody listens");
    if (step == 10) ask("reset");
    if (step == 25) ask("quit");
  };
  ASSERT_EQ(play(0, 9), 0);
  const auto all = reports();
  ASSERT_EQ(all.size(), 2u);
  EXPECT_EQ(all[0].at("steps").get<int>() + all[1].at("steps").get<int>(), steps_ + 1);
  EXPECT_NEAR(all[0].at("steps").get<int>(), 10, 2);
  EXPECT_EQ(all[0].at("commands").size(), 1u);
  EXPECT_EQ(all[1].at("commands").size(), 0u);
  for (const Json& report : all) {
    EXPECT_EQ(report.at("exercise").at("state"), "running");
    EXPECT_NEAR(report.at("series").at("time_s").front().get<double>(), 0.01, 1e-6) << "each begins at the start";
  }
}

TEST_F(SessionReportsTest, TheExerciseMayEndAgainAfterAReset) {
  on_step_ = [this](int step) {
    if (step == 30) ask("reset");
  };
  ASSERT_EQ(play(0.4, 0.2), 0);
  const auto all = reports();
  ASSERT_EQ(all.size(), 2u);
  EXPECT_EQ(all[0].at("steps"), 20);
  EXPECT_EQ(all[0].at("state_hash"), all[1].at("state_hash"));
  EXPECT_EQ(all[1].at("steps"), 20);
}

TEST_F(SessionReportsTest, TheRecordingSaysWhatWasFoundOfEachPass) {
  on_step_ = [this](int step) {
    if (step == 30) ask("reset");
  };
  record_ = folder_.path() / "run.insula";
  ASSERT_EQ(play(0.4, 0.2), 0);
  McapReader file(record_);
  std::vector<Json> reviews;
  file.read({file.channel(session::review_topic).value()}, 0, UINT64_MAX, [&](const McapReader::Message& m) {
    reviews.push_back(Json::parse(m.data.begin(), m.data.end()));
    return true;
  });
  ASSERT_EQ(reviews.size(), 2u);
  for (int k = 0; k < 2; ++k) {
    EXPECT_EQ(reviews[std::size_t(k)].at("pass"), k + 1);
    EXPECT_EQ(reviews[std::size_t(k)].at("review"), reports()[std::size_t(k)].at("review")) << "as in the report";
    EXPECT_EQ(reviews[std::size_t(k)].at("review").at("earlier_runs"), k);
  }
  EXPECT_EQ(reviews[1]["review"]["comparison"][0]["last"], "✓ yes");
}

TEST_F(SessionReportsTest, HoldsTheLargestForceBetweenTwoSteps) {
  on_step_ = [this](int step) {  // a peak that is over before the step looks
    if (step == 60) hand_force(0.75);
    hand_force(0.125);
  };
  ASSERT_EQ(play(1, 9), 0);
  const auto all = reports();
  ASSERT_EQ(all.size(), 1u);
  EXPECT_EQ(all[0].at("haptic").at("max_force_N").at("right"), 0.75);
  EXPECT_EQ(all[0].at("haptic").at("max_force_N").at("left"), 0);
  int peaks = 0, held = 0;
  for (const Json& force : all[0].at("series").at("hand_force_N").at("right")) {
    peaks += force == 0.75;
    held += force == 0.125;
  }
  EXPECT_EQ(peaks, 1);
  EXPECT_GT(held, 60);
}

TEST_F(SessionReportsTest, WhatCannotBeWrittenDoesNotEndTheSession) {
  std::ofstream(root()) << "a file";
  on_step_ = [this](int step) {
    if (step == 10) ask("reset");
  };
  testing::internal::CaptureStdout();
  EXPECT_EQ(play(0.5, 9), 0);
  const std::string said = testing::internal::GetCapturedStdout();
  EXPECT_GT(steps_, 50);
  EXPECT_NE(said.find("no report can be written there"), std::string::npos) << said;
  EXPECT_NE(said.find("a report was not written"), std::string::npos) << said;
  EXPECT_TRUE(fs::is_regular_file(root()));
}

TEST_F(SessionReportsTest, NothingIsWrittenBeforeTheFirstStep) {
  stop_ = true;
  ASSERT_EQ(play(0, 9), 0);
  EXPECT_TRUE(reports().empty());
}

TEST_F(SessionReportsTest, NoFolderIsTakenTwice) {
  EXPECT_EQ(new_report_folder(root(), "a"), root() / "a");
  EXPECT_EQ(new_report_folder(root(), "a"), root() / "a_2");
  EXPECT_EQ(new_report_folder(root(), "a"), root() / "a_3");
  const fs::path file = folder_.write("file", "x");
  EXPECT_THROW(new_report_folder(file, "a"), InputError);
}

}  // namespace
}  // namespace insula
