// SPDX-License-Identifier: GPL-3.0-or-later
// A session records by itself; its file has the same bits when it is rerun, also after its engine was killed.
#include <sys/wait.h>

#include <algorithm>
#include <cstdlib>
#include <fstream>
#include <nlohmann/json.hpp>

#include "tests/process/live_session.h"

namespace insula {
namespace {

using namespace testing;

class Recording : public LiveSession {
 protected:
  /// Adds an exercise with metrics.
  void prepare(std::vector<std::string>& options) override {
    std::string with = scene_text();
    with.insert(with.find("</scene>"),
                R"(<exercise id="e" title="Press"><hand_metrics/><bimanual_metrics/></exercise>)");
    std::ofstream(scene()) << with;
    options.insert(options.end(), {"--mode", "practice", "--field", "person=P07"});
  }
  fs::path scene() const { return session_->folder() / "press.xml"; }
  std::string scene_text() const {
    std::ifstream in(scene());
    return {std::istreambuf_iterator<char>(in), {}};
  }
  /// Exit status of `insula COMMAND`, whose output goes to a file of the session's folder.
  int insula(const std::string& command) const {
    const std::string line =
        std::string(INSULA_BINARY_DIR) + "/bin/insula " + command + " > " + output().string() + " 2>&1";
    const int status = std::system(line.c_str());
    return WIFEXITED(status) ? WEXITSTATUS(status) : -1;
  }
  fs::path output() const { return session_->folder() / "output.txt"; }
  std::string said() const {
    std::ifstream in(output());
    return {std::istreambuf_iterator<char>(in), {}};
  }
  nlohmann::json info(const fs::path& file) const {
    EXPECT_EQ(insula("session info --json " + file.string()), 0) << said();
    return nlohmann::json::parse(said());
  }
  static nlohmann::json report(const fs::path& folder) {
    std::ifstream in(folder / "report.json");
    return nlohmann::json::parse(in, nullptr, false);
  }
  /// The live session's last one.
  fs::path last_report() const {
    fs::path last;
    for (const auto& entry : fs::directory_iterator(reports())) last = std::max(last, entry.path());
    return last;
  }
  /// Recorded files, the first one first.
  std::vector<fs::path> files() const {
    std::vector<fs::path> out;
    std::error_code none;
    for (const auto& entry : fs::directory_iterator(session_->folder() / ".local/share/insula/sessions", none))
      out.push_back(entry.path());
    std::sort(out.begin(), out.end());
    return out;
  }
};

TEST_F(Recording, IsMadeByItselfAndHasTheSameBitsAgain) {
  ASSERT_TRUE(watcher_->press(0.1)) << watcher_->force();
  watcher_->ask("exchange", "left spare");  // done, or refused because of a contact
  watcher_->ask("pause");
  std::this_thread::sleep_for(300ms);
  ASSERT_TRUE(watcher_->asked("message", "well done", "message"));
  watcher_->ask("resume");
  watcher_->ask("reset");
  const std::size_t frames = watcher_->frames_now();
  ASSERT_TRUE(wait_for([&] { return watcher_->frames_now() > frames + 90; }));
  session_->end();
  ASSERT_EQ(files().size(), 1u) << session_->log();
  const auto json = info(files()[0]);
  EXPECT_EQ(json["title"], "Press");
  EXPECT_TRUE(json["ended"]);
  EXPECT_GE(json["resets"], 1);
  EXPECT_GE(json["commands"], 2);
  EXPECT_GT(json["steps"], 100);
  EXPECT_GT(json["device_states"], 0.5 * double(json["steps"])) << "62 a second and 60";
  EXPECT_GT(json["servo_ticks"], 5 * double(json["steps"])) << "1000 a second and 60; a busy machine misses some";
  EXPECT_EQ(json["fields"]["person"], "P07");
  EXPECT_EQ(insula("session verify " + files()[0].string()), 0) << said();
  const fs::path again = session_->folder() / "again";
  EXPECT_EQ(insula("rerun " + files()[0].string() + " --report " + again.string()), 0) << said();
  // Every metric that was recorded has the same bits again.
  EXPECT_EQ(insula("score --json " + files()[0].string()), 0) << said();
  const auto scored = nlohmann::json::parse(said())[0];
  EXPECT_GT(scored["metrics_again"]["compared"], 50);
  EXPECT_EQ(scored["metrics_again"]["different"], 0);
  EXPECT_EQ(json["passes"].size(), 2u) << "before and after the reset";
  // The report of the last pass is that of the live session.
  const nlohmann::json live = report(last_report()), rerun = report(again);
  EXPECT_EQ(live["fields"]["person"], "P07");
  for (const char* key : {"steps", "force_on", "state_hash", "channels", "metrics"})
    EXPECT_EQ(live[key], rerun[key]) << key;
}

TEST_F(Recording, OfAPersonIsForgottenWithItsReports) {
  watcher_->ask("reset");
  ASSERT_TRUE(wait_for([&] { return reports_written() == 1; })) << session_->log();
  session_->end();
  ASSERT_EQ(files().size(), 1u);
  const std::string folders = " --folder " + files()[0].parent_path().string() + " --folder " + reports().string();
  EXPECT_EQ(insula("session forget P0" + folders), 0);
  EXPECT_NE(said().find("there is nothing"), std::string::npos) << said();
  EXPECT_EQ(insula("session forget P07 --list" + folders), 0);
  EXPECT_NE(said().find(files()[0].string()), std::string::npos);
  ASSERT_EQ(files().size(), 1u) << "only listed";
  std::ofstream(files()[0].string() + ".notes.json") << "[]";
  EXPECT_EQ(insula("session forget P07" + folders), 0);
  EXPECT_TRUE(files().empty()) << "with the notes beside it";
  EXPECT_EQ(reports_written(), 0);
}

TEST_F(Recording, OfAKilledEngineHasAllButTheLastMoment) {
  ASSERT_TRUE(watcher_->press(0.1)) << watcher_->force();
  const std::int64_t engine = watcher_->frame_session();
  ASSERT_TRUE(wait_for([&] { return watcher_->frames_now() > 200; }));
  const std::size_t frames = watcher_->frames_now();
  session_->kill_child("engine");
  ASSERT_TRUE(wait_for([&] { return watcher_->frame_session() != engine && watcher_->frames_now() > 20; }));
  session_->end();
  ASSERT_EQ(files().size(), 2u) << session_->log();
  const auto json = info(files()[0]);
  EXPECT_FALSE(json["ended"]);
  // A chunk is written every half a second; a busy machine may be late.
  EXPECT_GT(double(json["steps"]), double(frames) - 120);
  EXPECT_EQ(insula("session verify " + files()[0].string()), 1) << said();
  EXPECT_NE(said().find("was not ended"), std::string::npos);
  EXPECT_NE(insula("rerun " + files()[0].string()), 2);
  EXPECT_EQ(said().find("other state"), std::string::npos) << said();
  EXPECT_EQ(insula("rerun " + files()[1].string()), 0) << said();
}

// A saved scene is another scene with its own report, so its engine begins another file. Each has its own scene.
TEST_F(Recording, OfASceneThatIsSavedHasTwoFilesWithTheSameBitsAgain) {
  ASSERT_TRUE(watcher_->press(0.1)) << watcher_->force();
  const std::int64_t first = watcher_->frame_session();
  std::string with = scene_text();
  const std::string before = "title=\"Press\"";
  with.replace(with.find(before), before.size(), "title=\"Pressed again\" gravity=\"0 0 -9 m/s2\"");
  std::ofstream(scene()) << with;
  ASSERT_TRUE(wait_for([&] { return watcher_->frame_session() != first && watcher_->frames_now() > 60; }))
      << session_->log();
  ASSERT_TRUE(watcher_->press(0.1)) << watcher_->force();
  session_->end();
  ASSERT_EQ(files().size(), 2u) << session_->log();
  const std::vector<std::string> titles{"Press", "Pressed again"};
  for (std::size_t k = 0; k < 2; ++k) {
    const auto json = info(files()[k]);
    EXPECT_EQ(json["title"], titles[k]);
    EXPECT_TRUE(json["ended"]) << titles[k];
    EXPECT_EQ(insula("session verify " + files()[k].string()), 0) << said();
    EXPECT_EQ(insula("rerun " + files()[k].string()), 0) << said();
  }
}

// The other two processes die and come back; the engine's recording knows no gap.
TEST_F(Recording, IsWholeAlthoughTheHapticServerAndTheGatewayWereKilled) {
  ASSERT_TRUE(watcher_->press(0.1)) << watcher_->force();
  for (const char* child : {"haptic_server", "gateway"}) {
    session_->kill_child(child);
    const std::size_t frames = watcher_->frames_now();
    ASSERT_TRUE(wait_for([&] { return watcher_->frames_now() > frames + 60; })) << child;
  }
  ASSERT_TRUE(watcher_->press(0.1)) << watcher_->force();
  session_->end();
  ASSERT_EQ(files().size(), 1u) << session_->log();
  EXPECT_TRUE(info(files()[0])["ended"]);
  EXPECT_EQ(insula("session verify " + files()[0].string()), 0) << said();
  EXPECT_EQ(insula("rerun " + files()[0].string()), 0) << said();
}

/// Date and time jump by a day and by a week in all processes.
class RecordingOverClockJumps : public Recording {
 protected:
  void prepare(std::vector<std::string>& options) override {
    Recording::prepare(options);
    ::setenv("LD_PRELOAD", INSULA_BINARY_DIR "/tests/jumping_clock.so", 1);
  }
  void SetUp() override {
    Recording::SetUp();
    ::unsetenv("LD_PRELOAD");
  }
};

TEST_F(RecordingOverClockJumps, IsWholeAndInOrder) {
  ASSERT_TRUE(watcher_->press(0.1)) << watcher_->force();
  const std::size_t frames = watcher_->frames_now();
  ASSERT_TRUE(wait_for([&] { return watcher_->frames_now() > frames + 300; })) << "five seconds of steps";
  ASSERT_TRUE(watcher_->press(0.1)) << watcher_->force();
  session_->end();
  ASSERT_EQ(files().size(), 1u) << session_->log();
  const auto json = info(files()[0]);
  EXPECT_TRUE(json["ended"]);
  EXPECT_EQ(json["resets"], 0);
  EXPECT_GE(json["steps"], 300);
  EXPECT_NEAR(json["seconds"], double(json["steps"]) * double(json["step_s"]), 0.1) << "simulated time has no jump";
  EXPECT_GT(json["servo_ticks"], 5 * double(json["steps"]));
  EXPECT_EQ(insula("session verify " + files()[0].string()), 0) << said();
  EXPECT_EQ(insula("rerun " + files()[0].string()), 0) << said();
}

}  // namespace
}  // namespace insula
