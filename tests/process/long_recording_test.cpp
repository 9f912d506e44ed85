// SPDX-License-Identifier: GPL-3.0-or-later
// Four hours of a small scene, recorded in half a minute: the memory does not grow with them, and any second is found.
#include <gtest/gtest.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include "core/testing/temp_folder.h"
#include "engine/session/session_reader.h"

namespace insula {
namespace {

namespace fs = std::filesystem;

constexpr const char* scene_text = R"(<scene title="Block" time_step="50 ms">
  <soft_body id="block" mesh="meshes/block.msh" mesh_unit="mm"><corotational_fem/>
    <fixed region="beyond" centre="0 0 -19 mm" normal="0 0 -1"/><surface/></soft_body>
</scene>)";

/// Runs the scene for that long and returns the largest memory of the program, MB; 0 if it failed.
double run_MB(const fs::path& scene, const std::string& duration, const fs::path& file) {
  const std::string program = INSULA_BINARY_DIR "/bin/insula";
  const pid_t child = ::fork();
  if (child == 0) {
    ::execl(program.c_str(), "insula", "run", scene.c_str(), "--duration", duration.c_str(), "--record", file.c_str(),
            "--quiet", nullptr);
    ::_exit(127);
  }
  int status = 0;
  rusage used{};
  ::wait4(child, &status, 0, &used);
  return WIFEXITED(status) && WEXITSTATUS(status) == 0 ? double(used.ru_maxrss) / 1024 : 0;
}

TEST(LongRecording, OfFourHoursNeedsNoMoreMemoryThanOfTenMinutes) {
  const test_files::TempFolder folder;
  const fs::path scene = folder.write("scene.xml", scene_text);
  fs::create_directories(folder.path() / "meshes");
  fs::copy(fs::path(INSULA_SOURCE_DIR) / "meshes/examples/block.msh", folder.path() / "meshes/block.msh");
  const double ten_minutes_MB = run_MB(scene, "600 s", folder.path() / "short.insula");
  ASSERT_GT(ten_minutes_MB, 0);
  const fs::path file = folder.path() / "long.insula";
  const double four_hours_MB = run_MB(scene, "14400 s", file);
  ASSERT_GT(four_hours_MB, 0);
  // An index of a few bytes for each chunk.
  EXPECT_LT(four_hours_MB, ten_minutes_MB + 16);

  SessionReader session(file);
  EXPECT_TRUE(session.container().ended());
  EXPECT_TRUE(session.container().damage().empty());
  const auto step = session.container().channel("STEP");
  ASSERT_TRUE(step);
  // A second before the third hour's end, by the index.
  int found = 0;
  session.container().read({*step}, 10'799'000'000'001, 10'800'000'000'000, [&](const McapReader::Message&) {
    ++found;
    return true;
  });
  EXPECT_EQ(found, 20);
  std::int64_t last = 0;
  session.steps([&](const insula_lcm::session_step_t& s) {
    last = s.number;
    return true;
  });
  EXPECT_EQ(last, 288'000);
}

}  // namespace
}  // namespace insula
