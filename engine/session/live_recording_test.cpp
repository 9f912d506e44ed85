// SPDX-License-Identifier: GPL-3.0-or-later
// Files of live recordings: none is shared or overwritten, and a place that takes none ends no session.
#include "engine/session/live_recording.h"

#include <gtest/gtest.h>

#include <set>
#include <thread>

#include "core/base/input_error.h"
#include "core/testing/example.h"
#include "core/testing/temp_folder.h"
#include "engine/session/session_reader.h"

namespace insula {
namespace {

namespace fs = std::filesystem;
const fs::path example = fs::path(INSULA_SOURCE_DIR) / "plugins/motion_metrics/example.xml";

TEST(LiveRecording, SessionsThatBeginAtTheSameMomentHaveFilesOfTheirOwn) {
  const test_files::TempFolder folder;
  constexpr int sessions = 8, each = 20;
  std::vector<std::set<fs::path>> made(sessions);
  std::vector<std::thread> threads;
  for (int k = 0; k < sessions; ++k)
    threads.emplace_back([&, k] {
      for (int i = 0; i < each; ++i) made[std::size_t(k)].insert(new_session_file(folder.path() / "a.insula", example));
    });
  for (auto& t : threads) t.join();
  std::set<fs::path> all;
  for (const auto& files : made) all.insert(files.begin(), files.end());
  EXPECT_EQ(all.size(), std::size_t(sessions * each));
}

TEST(LiveRecording, APlaceThatTakesNoFileEndsNoSession) {
  const test_files::TempFolder folder;
  const fs::path file = folder.write("file", "no folder");
  EXPECT_THROW(new_session_file(file / "sessions", example), InputError);
  const auto s = test::load(example);
  ASSERT_TRUE(s);
  LiveRecording recording(file / "sessions", *s, {example, "", "live"});
  EXPECT_NE(recording.failure(), "");
  EXPECT_EQ(recording.file(), "");
  s->step();
  recording.step(*s);
  recording.end_pass(*s);
  recording.note({});
  recording.close(*s);
  EXPECT_EQ(s->steps(), 1);
}

TEST(LiveRecording, ASessionWithoutAStepLeavesNoFile) {
  const test_files::TempFolder folder;
  const auto s = test::load(example);
  ASSERT_TRUE(s);
  for (const bool steps : {false, true}) {
    LiveRecording recording(folder.path(), *s, {example, "", "live"});
    const fs::path file = recording.file();
    EXPECT_TRUE(fs::exists(file));
    if (steps) {
      s->step();
      recording.step(*s);
    }
    recording.close(*s);
    EXPECT_EQ(fs::exists(file), steps);
    if (steps) {
      EXPECT_EQ(SessionReader(file).about("title"), "Metrics of motion");
    }
  }
}

}  // namespace
}  // namespace insula
