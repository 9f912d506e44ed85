// SPDX-License-Identifier: GPL-3.0-or-later
#include "engine/sharing/scene_names.h"

#include <gtest/gtest.h>

#include <set>
#include <stdexcept>

#include "core/base/input_error.h"
#include "core/testing/temp_folder.h"

namespace insula {
namespace {

namespace fs = std::filesystem;

fs::path called(const std::string& given, const std::vector<NamedScene>& scenes) {
  return scene_called(given, [&] { return scenes; });
}

std::string error_of(const std::string& given, const std::vector<NamedScene>& scenes) {
  try {
    return "no error: " + called(given, scenes).string();
  } catch (const InputError& e) {
    return e.what();
  }
}

TEST(SceneNames, AreThoseOfFilesAndOfTheFoldersOfCases) {
  test_files::TempFolder folder;
  for (const char* file : {"training/2_open.xml", "skills/1_touch.xml", "cases/alone.xml", "cases/tip/case.xml",
                           "cases/tip/pause.xml", "cases/mine/3_clipping.xml"})
    folder.write(fs::path("scenes") / file, "<scene/>");
  folder.write("scenes/cases/tip/artery.xml", "<part/>");
  folder.write("scenes/training/2_open_steady.csv", "<scene/>");
  const auto scenes = shipped_scenes(folder.path());
  std::vector<std::string> names;
  for (const NamedScene& s : scenes) names.push_back(s.name);
  EXPECT_EQ(names, (std::vector<std::string>{"open", "touch", "alone", "mine/clipping", "tip", "tip/pause"}));
  EXPECT_EQ(called("open", scenes), folder.path() / "scenes/training/2_open.xml");
  EXPECT_EQ(called("2_open", scenes), folder.path() / "scenes/training/2_open.xml");
  EXPECT_EQ(called("tip/pause", scenes), folder.path() / "scenes/cases/tip/pause.xml");
  EXPECT_EQ(error_of("tip/pose", scenes), "no scene \"tip/pose\"; did you mean \"tip/pause\"?");
  EXPECT_EQ(error_of("4_open", scenes), "no scene \"4_open\"; did you mean \"open\"?");
  EXPECT_EQ(error_of("case", {scenes.begin(), scenes.begin() + 2}), "no scene \"case\"; there are open, touch");
}

TEST(SceneNames, FilesAreLeftToTheLoader) {
  test_files::TempFolder folder;
  folder.write("plain", "<scene/>");
  const auto unasked = []() -> std::vector<NamedScene> { throw std::logic_error("a file needs no list of scenes"); };
  EXPECT_EQ(scene_called((folder.path() / "plain").string(), unasked), folder.path() / "plain");
  EXPECT_EQ(scene_called("nowhere/mine.xml", unasked), "nowhere/mine.xml");
  EXPECT_EQ(scene_called("/nowhere/mine", unasked), "/nowhere/mine");
}

TEST(SceneNames, OfTheProjectDiffer) {
  std::set<std::string> names;
  const auto scenes = shipped_scenes(INSULA_SOURCE_DIR);
  for (const NamedScene& s : scenes) names.insert(s.name);
  EXPECT_EQ(names.size(), scenes.size());
  EXPECT_TRUE(names.contains("clipping") && names.contains("basilar_tip/pause"));
}

}  // namespace
}  // namespace insula
