// SPDX-License-Identifier: GPL-3.0-or-later
// insula cases: a case that does not load here is not added, and one that does is listed and can be removed.
#include "engine/command_line/cases.h"

#include <gtest/gtest.h>

#include <sstream>

#include "core/registry/registry.h"
#include "core/testing/block_mesh.h"
#include "engine/sharing/case_archive.h"

namespace insula {
namespace {
namespace fs = std::filesystem;

class CasesCommand : public testing::Test {
 protected:
  CasesCommand() {
    register_builtin(registry_);
    options_.data = folder_.path() / "data";
  }
  fs::path packed(const std::string& name, const std::string& scene) {
    folder_.write(name + "/a.xml", scene);
    pack_case(name, {folder_.path() / name / "a.xml"}, {}, folder_.path() / (name + ".zip"));
    return folder_.path() / (name + ".zip");
  }
  int run(int (*command)(const CommandContext&, const CasesOptions&)) {
    out_.str(""), err_.str("");
    return command({registry_, out_, err_}, options_);
  }

  test::SceneFolder folder_;
  Registry registry_;
  CasesOptions options_;
  std::ostringstream out_, err_;
};

TEST_F(CasesCommand, ACaseIsAddedListedAndRemoved) {
  options_.file = packed("tip", R"(<scene><exercise title="Tip" text="Look."/></scene>)");
  ASSERT_EQ(run(cmd_cases_add), 0) << err_.str();
  EXPECT_EQ(run(cmd_cases_add), 2);
  EXPECT_NE(err_.str().find("is there already"), std::string::npos);
  ASSERT_EQ(run(cmd_cases), 0);
  EXPECT_NE(out_.str().find("tip "), std::string::npos);
  EXPECT_NE(out_.str().find("1 exercise, added: a\n"), std::string::npos) << "an exercise without an id: the file";
  options_.name = "tip";
  ASSERT_EQ(run(cmd_cases_remove), 0);
  EXPECT_EQ(run(cmd_cases_remove), 2);
  ASSERT_EQ(run(cmd_cases), 0);
  EXPECT_EQ(out_.str().find("added"), std::string::npos);
  options_.name = "../data";
  EXPECT_EQ(run(cmd_cases_remove), 2);
  EXPECT_TRUE(fs::exists(options_.data / "cases"));
}

TEST_F(CasesCommand, TheFolderOfABuiltCaseIsAdded) {
  folder_.write("tip/1_a.xml", R"(<scene><exercise title="Tip" text="Look."/></scene>)");
  options_.file = folder_.path() / "tip";
  ASSERT_EQ(run(cmd_cases_add), 0) << err_.str();
  EXPECT_EQ(run(cmd_cases_add), 2) << "it is there already";
  options_.replace = true;
  folder_.write("tip/2_b.xml", R"(<scene><exercise id="more" title="More" text="Look."/></scene>)");
  ASSERT_EQ(run(cmd_cases_add), 0) << err_.str();
  ASSERT_EQ(run(cmd_cases), 0);
  EXPECT_NE(out_.str().find("2 exercises, added: 1_a, more\n"), std::string::npos) << out_.str();
  folder_.write("tip/2_b.xml", R"(<scene><exercise title="More" textt="Look."/></scene>)");
  EXPECT_EQ(run(cmd_cases_add), 2);
  ASSERT_EQ(run(cmd_cases), 0);
  EXPECT_NE(out_.str().find("2 exercises, added"), std::string::npos) << "the one before stays";
}

TEST_F(CasesCommand, ASceneWithErrorsIsNotAdded) {
  options_.file = packed("broken", R"(<scene><exercise textt="Look."/></scene>)");
  EXPECT_EQ(run(cmd_cases_add), 2);
  EXPECT_NE(err_.str().find("did you mean \"text\""), std::string::npos) << err_.str();
  EXPECT_FALSE(fs::exists(options_.data / "cases/broken"));
}

TEST_F(CasesCommand, ASceneIsCopiedToBeEditedWithAllThatItNames) {
  folder_.write("own/a.xml", R"(<scene><include file="parts/b.xml"/></scene>)");
  folder_.write("own/parts/b.xml", R"(<scene><exercise textt="Look."/></scene>)");  // a mistake may be copied
  options_.file = folder_.path() / "own/a.xml";
  options_.to = folder_.path() / "copies/mine";
  ASSERT_EQ(run(cmd_cases_copy), 0) << err_.str();
  EXPECT_TRUE(fs::is_regular_file(options_.to / "a.xml"));
  EXPECT_TRUE(fs::is_regular_file(options_.to / "parts/b.xml"));
  EXPECT_EQ(std::distance(fs::directory_iterator(options_.to.parent_path()), fs::directory_iterator()), 1);
  EXPECT_EQ(run(cmd_cases_copy), 2) << "it is there already";
}

TEST_F(CasesCommand, AllScenesOfABuiltCaseAreCopied) {
  folder_.write("tip/1_a.xml", R"(<scene><exercise title="Tip" text="Look."/></scene>)");
  folder_.write("tip/2_b.xml", R"(<scene><exercise title="More" text="Look."/></scene>)");
  options_.file = folder_.path() / "tip";
  options_.to = folder_.path() / "copies/other_name";
  ASSERT_EQ(run(cmd_cases_copy), 0) << err_.str();
  EXPECT_TRUE(fs::is_regular_file(options_.to / "2_b.xml"));
}

TEST_F(CasesCommand, AnUnknownCaseIsNotPacked) {
  options_.name = "nobody_has_this";
  EXPECT_EQ(run(cmd_cases_pack), 2);
  EXPECT_NE(err_.str().find("there is no case"), std::string::npos);
}

}  // namespace
}  // namespace insula
