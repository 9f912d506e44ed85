// SPDX-License-Identifier: GPL-3.0-or-later
// What a session needs to follow its scene: which files it is made of, when one has been saved, and the text for the
// viewers.
#include <gtest/gtest.h>
#include <unistd.h>

#include <algorithm>
#include <cstdlib>
#include <fstream>

#include "core/testing/temp_folder.h"
#include "engine/live/file_watch.h"
#include "engine/live/notice.h"
#include "engine/live/scene_files.h"

namespace fs = std::filesystem;

namespace insula {
namespace {

class Reload : public ::testing::Test {
 protected:
  fs::path write(const std::string& name, const std::string& text) const {
    fs::create_directories((folder_ / name).parent_path());
    std::ofstream(folder_ / name) << text;
    return folder_ / name;
  }
  /// Names below the folder.
  std::vector<std::string> files(const std::string& scene) const {
    std::vector<std::string> out;
    for (const fs::path& f : scene_files(folder_ / scene))
      out.push_back(f.lexically_relative(folder_).generic_string());
    return out;
  }
  test_files::TempFolder temporary_;
  fs::path folder_ = fs::canonical(temporary_.path());
};

TEST_F(Reload, FilesOfASceneAndOfWhatItIncludes) {
  write("meshes/a.msh", "");
  write("meshes/tool/tool.urdf", "");
  write("meshes/tool/tool.json", "");
  write("meshes/tool/blade.obj", "");
  write("parts/p.xml", R"(<part><variable name="m" value="../meshes/a.msh"/><soft_body mesh="$m"/></part>)");
  write(
      "s.xml",
      R"(<scene title="no file at all"><include file="parts/p.xml"/><dissector model="meshes/tool/tool.urdf" home="1 2 3.5 mm"/></scene>)");
  EXPECT_EQ(files("s.xml"), (std::vector<std::string>{"meshes/a.msh", "meshes/tool/blade.obj", "meshes/tool/tool.json",
                                                      "meshes/tool/tool.urdf", "parts/p.xml", "s.xml"}));
}

TEST_F(Reload, FilesOfASceneWithErrors) {
  write("s.xml", R"(<scene><include file="later.xml"/><nonsense mesh="missing.msh"/></scene>)");
  const auto found = files("s.xml");
  EXPECT_EQ(found, (std::vector<std::string>{"later.xml", "missing.msh", "s.xml"}));
  write("s.xml", "<scene><not closed");
  EXPECT_EQ(files("s.xml"), std::vector<std::string>{"s.xml"});
  EXPECT_EQ(files("none.xml"), std::vector<std::string>{"none.xml"});
}

TEST_F(Reload, ASaveCountsOnceAndOnlyWhenItIsOver) {
  using std::chrono::milliseconds;
  FileWatch watch(milliseconds(300));
  const fs::path a = write("a.xml", "1");
  watch.set({a, folder_ / "b.xml"});
  auto now = FileWatch::Clock::now();
  const auto after = [&](int ms) { return watch.saved(now += milliseconds(ms)); };
  EXPECT_FALSE(after(1000)) << "nothing was saved";
  write("a.xml", "12");
  EXPECT_FALSE(after(100)) << "just changed";
  write("a.xml", "123");
  EXPECT_FALSE(after(250)) << "still being written";
  EXPECT_FALSE(after(250)) << "not yet quiet";
  EXPECT_TRUE(after(100));
  EXPECT_FALSE(after(1000)) << "told already";
  write("b.xml", "new");
  EXPECT_FALSE(after(10));
  EXPECT_TRUE(after(400)) << "a file that appears";
  fs::remove(a);
  EXPECT_FALSE(after(10));
  EXPECT_TRUE(after(400)) << "a file that goes";
}

TEST_F(Reload, ANoticeComesAndGoes) {
  const fs::path file = folder_ / "notice.txt";
  EXPECT_EQ(Notice("").text(), "");
  EXPECT_EQ(Notice(file).text(), "");
  ASSERT_TRUE(leave_notice(file, "a.xml:1:2: error: x\n"));
  EXPECT_EQ(Notice(file).text(), "a.xml:1:2: error: x\n");
  std::string line(99, 'x'), many;
  for (int i = 0; i < 1000; ++i) many += line + "\n";
  ASSERT_TRUE(leave_notice(file, many));
  const std::string cut = Notice(file).text();
  EXPECT_LE(cut.size(), Notice::max_bytes + 4);
  EXPECT_TRUE(cut.ends_with(line + "\n...\n"));
  EXPECT_FALSE(leave_notice(folder_ / "no" / "folder", "x"));
}

}  // namespace
}  // namespace insula
