// SPDX-License-Identifier: GPL-3.0-or-later
// A case goes into an archive and comes out the same; an archive that is not what was packed is refused whole.
#include "engine/sharing/case_archive.h"

#include <gtest/gtest.h>
#include <zip.h>

#include <fstream>
#include <map>
#include <nlohmann/json.hpp>

#include "core/base/input_error.h"
#include "core/model/formats/file_bytes.h"
#include "core/testing/block_mesh.h"
#include "engine/session/session_files.h"
#include "engine/sharing/case_list.h"
#include "engine/sharing/case_page.h"

namespace insula {
namespace {
namespace fs = std::filesystem;

constexpr const char* scene_text =
    R"(<scene title="Bifurcation &lt;left&gt;"><include file="parts/light.xml"/>
<exercise site="basilar tip" difficulty="2" text="Clip it."/></scene>)";

class CaseArchive : public testing::Test {
 protected:
  test::SceneFolder folder_;
  fs::path root_ = folder_.path();

  fs::path write(const std::string& name, const std::string& text) {
    folder_.write(name, text);
    return root_ / name;
  }
  /// A project with one case of two exercises.
  fs::path project() {
    write("project/scenes/cases/tip/1_open.xml", scene_text);
    write("project/scenes/cases/tip/2_clip.xml", scene_text);
    write("project/scenes/cases/tip/parts/light.xml", "<scene/>");
    write("project/scenes/cases/tip/2_clip.jpg", "picture");
    write("project/scenes/cases/tip/report.json", R"({"neck": {"diameter_mm": 3.14}})");
    return root_ / "project";
  }
  ListedCase listed() {
    const auto cases = list_cases(project(), root_ / "data");
    EXPECT_EQ(cases.size(), 1u);
    return cases.at(0);
  }
  /// An archive with these entries beside its list.
  fs::path archive(const std::map<std::string, std::string>& files, nlohmann::json manifest = {}) {
    const fs::path out = root_ / "made.zip";
    fs::remove(out);
    if (manifest.is_null()) {
      manifest = {{"format", 1}, {"name", "tip"}, {"scenes", {"a.xml"}}, {"files", nlohmann::json::object()}};
      for (const auto& [name, text] : files)
        manifest["files"][name] = sha256({reinterpret_cast<const std::uint8_t*>(text.data()), text.size()});
    }
    const std::string list = manifest.dump();
    zip_t* z = zip_open(out.c_str(), ZIP_CREATE, nullptr);
    const auto add = [&](const std::string& name, const std::string& text) {
      zip_file_add(z, name.c_str(), zip_source_buffer(z, text.data(), text.size(), 0), ZIP_FL_ENC_UTF_8);
    };
    add(case_manifest, list);
    for (const auto& [name, text] : files) add(name, text);
    zip_close(z);
    return out;
  }
  std::string refusal(const fs::path& file) {
    std::string why;
    try {
      unpack_case(file, root_ / "data/cases");
    } catch (const InputError& e) {
      why = e.what();
    }
    EXPECT_FALSE(fs::exists(root_ / "data/cases/tip"));
    EXPECT_TRUE(!fs::exists(root_ / "data/cases") || fs::is_empty(root_ / "data/cases"));
    return why;
  }
};

TEST_F(CaseArchive, GivesTheSameFilesAndTheSameBytes) {
  const ListedCase c = listed();
  EXPECT_EQ(c.name, "tip");
  EXPECT_EQ(c.site(), "basilar tip");
  ASSERT_EQ(c.exercises.size(), 2u);
  const PackedCase packed = pack_listed(c, root_ / "project", root_ / "a.zip");
  EXPECT_EQ(packed.scenes, (std::vector<std::string>{"1_open.xml", "2_clip.xml"}));
  EXPECT_EQ(packed.files, 5u);
  pack_listed(c, root_ / "project", root_ / "b.zip");
  EXPECT_EQ(read_file_bytes(root_ / "a.zip"), read_file_bytes(root_ / "b.zip"));

  const PackedCase out = unpack_case(root_ / "a.zip", root_ / "data/cases");
  EXPECT_EQ(out.name, "tip");
  EXPECT_EQ(out.files, packed.files);
  EXPECT_EQ(out.bytes, packed.bytes);
  for (const char* f : {"1_open.xml", "2_clip.xml", "parts/light.xml", "2_clip.jpg", "report.json"})
    EXPECT_EQ(read_file_bytes(root_ / "data/cases/tip" / f), read_file_bytes(root_ / "project/scenes/cases/tip" / f));

  // It is listed beside the project's own, and its exercises are on the start page.
  const auto cases = list_cases(root_ / "project", root_ / "data");
  ASSERT_EQ(cases.size(), 2u);
  EXPECT_TRUE(cases[1].added);
  EXPECT_EQ(cases[1].report, c.report);
  const auto exercises = added_exercises(root_ / "data");
  ASSERT_EQ(exercises.size(), 2u);
  EXPECT_EQ(exercises[0].of_case, exercises[1].of_case);
  EXPECT_NE(exercises[0].of_case, c.exercises[0].of_case) << "the project has a case of the same name";
  EXPECT_EQ(exercises[0].title, "Bifurcation <left>");
  EXPECT_TRUE(fs::path(exercises[0].scene).is_absolute());
  EXPECT_THROW(unpack_case(root_ / "a.zip", root_ / "data/cases"), InputError);  // it is there already
}

TEST_F(CaseArchive, WhatIsNotACaseIsRefusedAndLeavesNothing) {
  EXPECT_NE(refusal(write("text.zip", "no archive")).find("is no case"), std::string::npos);
  EXPECT_NE(refusal(root_ / "nowhere.zip").find("is no case"), std::string::npos);
  const std::string scene = "<scene/>";
  EXPECT_NE(refusal(archive({{"a.xml", scene}, {"../evil.xml", scene}})).find("outside of its folder"),
            std::string::npos);
  EXPECT_NE(refusal(archive({{"a.xml", scene}, {"/evil.xml", scene}})).find("outside of its folder"),
            std::string::npos);
  EXPECT_NE(refusal(archive({{"a.xml", scene}, {"x\\y.xml", scene}})).find("outside of its folder"), std::string::npos);
  EXPECT_NE(refusal(archive({{"a.xml", scene}, {".hidden.xml", scene}})).find("outside of its folder"),
            std::string::npos);
  EXPECT_NE(refusal(archive({{"a.xml", scene}, {"plugin.so", "x"}})).find("of a kind that no case has"),
            std::string::npos);
  const auto manifest = [&](const char* name, const nlohmann::json& scenes, const nlohmann::json& files) {
    return nlohmann::json{{"format", 1}, {"name", name}, {"scenes", scenes}, {"files", files}};
  };
  const std::string right = sha256({reinterpret_cast<const std::uint8_t*>(scene.data()), scene.size()});
  const std::string wrong(64, '0');
  EXPECT_NE(refusal(archive({{"a.xml", scene}}, manifest("tip", {"a.xml"}, {{"a.xml", wrong}}))).find("not the one"),
            std::string::npos);
  EXPECT_NE(
      refusal(archive({{"a.xml", scene}}, manifest("../tip", {"a.xml"}, {{"a.xml", right}}))).find("has the name"),
      std::string::npos);
  EXPECT_NE(
      refusal(archive({{"a.xml", scene}}, manifest("tip", {"b.xml"}, {{"a.xml", right}}))).find("lacks its scene"),
      std::string::npos);
  EXPECT_NE(refusal(archive({}, manifest("tip", {"a.xml"}, {{"a.xml", right}}))).find("has no file \"a.xml\""),
            std::string::npos);
  EXPECT_NE(refusal(archive({{"a.xml", scene}, {"b.xml", scene}}, manifest("tip", {"a.xml"}, {{"a.xml", right}})))
                .find("beside its list"),
            std::string::npos);
  EXPECT_NE(refusal(archive({{"a.xml", scene}}, {{"format", 2}})).find("another version"), std::string::npos);
  EXPECT_NE(refusal(archive({{"a.xml", scene}}, {{"format", 1}, {"name", 3}})).find("has a wrong"), std::string::npos);
}

TEST_F(CaseArchive, EveryCutAndEveryFlippedByteIsRefused) {
  const ListedCase c = listed();
  pack_listed(c, root_ / "project", root_ / "a.zip");
  const std::string whole = read_file_bytes(root_ / "a.zip");
  int accepted = 0;
  for (std::size_t n = 0; n < whole.size(); n += 7) {
    std::string bytes = whole;
    if (n % 2) bytes.resize(n);
    else bytes[n] = char(bytes[n] ^ 0x41);
    write("damaged.zip", bytes);
    try {
      unpack_case(root_ / "damaged.zip", root_ / "data/cases");
      // A byte of a header that nobody reads, such as a date: then every file is still as it was packed.
      ++accepted;
      EXPECT_EQ(read_file_bytes(root_ / "data/cases/tip/1_open.xml"), scene_text) << n;
      fs::remove_all(root_ / "data/cases/tip");
    } catch (const InputError&) {
    }
  }
  EXPECT_LT(accepted, int(whole.size()) / 14);
}

TEST_F(CaseArchive, ASceneThatIsNotThereAndAWrongNameAreRefused) {
  EXPECT_THROW(pack_case("loose", {root_ / "gone.xml"}, {}, root_ / "loose.zip"), InputError);
  EXPECT_THROW(pack_case("a/b", {write("a.xml", "<scene/>")}, {}, root_ / "loose.zip"), InputError);
  EXPECT_FALSE(fs::exists(root_ / "loose.zip"));
}

TEST_F(CaseArchive, APageShowsEachCaseAndEscapesItsWords) {
  const std::vector<ListedCase> cases{listed()};
  write_case_page(cases, root_ / "project", root_ / "site");
  const std::string page = read_file_bytes(root_ / "site/index.html");
  for (const char* part : {"Bifurcation &lt;left&gt;", "basilar tip", "difficulty 2 of 5", "neck 3.1 mm", "tip.zip",
                           "tip.jpg", "never for the care of patients"})
    EXPECT_NE(page.find(part), std::string::npos) << part;
  EXPECT_EQ(read_file_bytes(root_ / "site/tip.jpg"), "picture");
  EXPECT_EQ(unpack_case(root_ / "site/tip.zip", root_ / "elsewhere").scenes.size(), 2u);
}

}  // namespace
}  // namespace insula
