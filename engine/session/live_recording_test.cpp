// SPDX-License-Identifier: GPL-3.0-or-later
// Files of live recordings: none is shared or overwritten, and a place that takes none ends no session.
#include "engine/session/live_recording.h"

#include <gtest/gtest.h>
#include <unistd.h>

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

/// No recording can be made in the folder, and the session goes on without one.
void expect_no_recording(const fs::path& folder, Simulation& s) {
  EXPECT_THROW(new_session_file(folder, example), InputError);
  LiveRecording recording(folder, s, {example, "", "live"});
  EXPECT_NE(recording.failure(), "");
  EXPECT_EQ(recording.file(), "");
  s.step();
  recording.step(s);
  recording.end_pass(s);
  recording.note({});
  recording.close(s);
  EXPECT_EQ(s.steps(), 1);
}

TEST(LiveRecording, APlaceThatIsNoFolderEndsNoSession) {
  const test_files::TempFolder folder;
  const auto s = test::load(example);
  ASSERT_TRUE(s);
  expect_no_recording(folder.write("file", "no folder") / "sessions", *s);
}

TEST(LiveRecording, AReadOnlyFolderEndsNoSession) {
  const test_files::TempFolder folder;
  const auto s = test::load(example);
  ASSERT_TRUE(s);
  fs::permissions(folder.path(), fs::perms(0555));
  // The superuser may write everywhere, so this is done as somebody else.
  constexpr uid_t nobody = 65534;
  const uid_t user = geteuid();
  if (user == 0) {
    ASSERT_EQ(seteuid(nobody), 0);
  }
  expect_no_recording(folder.path(), *s);
  ASSERT_EQ(seteuid(user), 0);
  EXPECT_TRUE(fs::is_empty(folder.path()));
  fs::permissions(folder.path(), fs::perms(0755));
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
