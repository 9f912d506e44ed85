// SPDX-License-Identifier: GPL-3.0-or-later
// The commands that read declarations and scenes: what they print and which status they return.
#include "engine/command_line/commands.h"

#include <gtest/gtest.h>
#include <unistd.h>

#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>
#include <sstream>

#include "tools/workbench/workbench.h"

namespace insula {
namespace {
namespace fs = std::filesystem;

struct Jelly : Component {
  Param<Pressure> young{this,
                        {.name = "young", .min = "1 Pa", .max = "1 GPa", .doc = "Young's modulus <of the tissue>"}};
  Param<Choice> side{this, {.name = "side", .fallback = "left", .choices = {"left", "right"}, .doc = "which hand"}};
  Param<Torque> torque{this, {.name = "torque", .fallback = "0 N m", .doc = "twist"}};
  Param<Vec<Length>> at{this, {.name = "at", .fallback = "0 0 0 mm", .doc = "place"}};
  Param<LengthUnit> unit{this, {.name = "unit", .fallback = "mm", .doc = "unit of the file"}};
  RefList<Component> others{this, {.name = "others", .fallback = "", .doc = "others"}};
};
struct Inner : Component {};

class Commands : public testing::Test {
 protected:
  void SetUp() override {
    register_builtin(registry_);
    registry_.set_current_plugin("jelly_plugin");
    registry_.add<Jelly>("test_jelly", Kind::body, "soft & wobbly");
    registry_.add<Inner>("test_inner", Kind::support, "holds it");
    folder_ = fs::path(testing::TempDir()) / ("insula_commands" + std::to_string(::getpid()));
    fs::remove_all(folder_);
    fs::create_directories(folder_);
  }
  void TearDown() override { fs::remove_all(folder_); }
  fs::path write(const std::string& name, std::string_view text) {
    std::ofstream(folder_ / name, std::ios::binary) << text;
    return folder_ / name;
  }
  CommandContext context() { return {registry_, out_, err_}; }
  bool printed(const std::string& text) const { return out_.str().find(text) != std::string::npos; }

  Registry registry_;
  std::ostringstream out_, err_;
  fs::path folder_;
};

TEST_F(Commands, CheckReportsAllFiles) {
  const auto good = write("good.xml", "<scene><test_jelly young=\"2 kPa\"><test_inner/></test_jelly></scene>");
  const auto bad = write("bad.xml", "<scene><test_jelly yung=\"2 kPa\"/></scene>");
  EXPECT_EQ(cmd_check(context(), {good}), 0);
  EXPECT_TRUE(printed("good.xml: ok, 2 components, 1 bodies"));
  EXPECT_EQ(err_.str(), "");
  EXPECT_EQ(cmd_check(context(), {bad, good, folder_ / "none.xml"}), 2);
  EXPECT_NE(err_.str().find("bad.xml:1:20: error: <test_jelly> has no parameter \"yung\"; did you mean \"young\"?\n"),
            std::string::npos);
  EXPECT_NE(err_.str().find("none.xml: error: no such file\n"), std::string::npos);
}

TEST_F(Commands, CheckPrintsWarningsOfGoodScenes) {
  EXPECT_EQ(cmd_check(context(), {write("w.xml", "<scene><variable name=\"x\" value=\"1\"/></scene>")}), 0);
  EXPECT_NE(err_.str().find("warning: variable \"x\" is not used"), std::string::npos);
}

TEST_F(Commands, CheckTellsEditorsWhatIsWrongAndWhatWasMeant) {
  const auto good = write("good.xml", "<scene><test_jelly young=\"2 kPa\"/></scene>");
  const auto bad = write("bad.xml", "<scene><test_jelly yung=\"2 kPa\"/><test_jell/></scene>");
  EXPECT_EQ(cmd_check_json(context(), {good}), 0);
  EXPECT_EQ(nlohmann::json::parse(out_.str()), (nlohmann::json{{"ok", true}, {"problems", nlohmann::json::array()}}));
  out_.str("");
  EXPECT_EQ(cmd_check_json(context(), {bad}), 2);
  const auto problems = nlohmann::json::parse(out_.str())["problems"];
  EXPECT_EQ(problems[0]["file"], bad.generic_string());
  EXPECT_EQ(problems[0]["line"], 1);
  ASSERT_EQ(problems.size(), 2u) << problems;
  EXPECT_EQ(problems[0]["column"], 20);
  EXPECT_EQ(problems[0]["text"], "<test_jelly> has no parameter \"yung\"; did you mean \"young\"?");
  EXPECT_EQ(problems[0]["nearest"], "young");
  EXPECT_EQ(problems[1]["nearest"], "test_jelly");
  EXPECT_EQ(err_.str(), "");
}

TEST_F(Commands, ListTellsEditorsAllDeclarations) {
  ListOptions options;
  options.json = true;
  EXPECT_EQ(cmd_list(context(), options), 0);
  const auto elements = nlohmann::json::parse(out_.str())["elements"];
  const auto find = [](const nlohmann::json& list, const std::string& name) {
    for (const auto& one : list)
      if (one["name"] == name) return one;
    return nlohmann::json();
  };
  for (const auto* info : registry_.all()) EXPECT_FALSE(find(elements, info->element).is_null()) << info->element;
  const auto jelly = find(elements, "test_jelly");
  const auto young = find(jelly["parameters"], "young"), at = find(jelly["parameters"], "at");
  EXPECT_EQ(young["required"], true);
  EXPECT_EQ(young["max"], "1 GPa");
  EXPECT_EQ(young["numbers"], 1);
  EXPECT_EQ(young["units"][1]["symbol"], "kPa");
  EXPECT_EQ(young["units"][1]["to_si"], 1000);
  EXPECT_EQ(at["default"], "0 0 0 mm");
  EXPECT_EQ(at["numbers"], 3);
  EXPECT_EQ(find(jelly["parameters"], "side")["choices"], (nlohmann::json{"left", "right"}));
  EXPECT_EQ(find(jelly["parameters"], "others")["list"], true);
  const auto holds = [&](const char* parent, const char* child) {
    const auto children = find(elements, parent)["children"];
    return std::find(children.begin(), children.end(), child) != children.end();
  };
  EXPECT_TRUE(holds("scene", "test_jelly") && holds("test_jelly", "test_inner") && holds("scene", "variable"));
  EXPECT_FALSE(holds("scene", "test_inner") || holds("view", "include"));
}

TEST_F(Commands, ListNamesEveryElement) {
  EXPECT_EQ(cmd_list(context()), 0);
  for (const auto* info : registry_.all()) EXPECT_TRUE(printed("  " + info->element + " ")) << info->element;
  EXPECT_TRUE(printed("soft & wobbly [jelly_plugin]"));
}

TEST_F(Commands, DescribeShowsEveryParameter) {
  for (const auto* info : registry_.all()) {
    out_.str("");
    EXPECT_EQ(cmd_describe(context(), info->element), 0);
    const auto component = registry_.create(info->element);
    for (const ParamBase* p : component->params()) EXPECT_TRUE(printed("  " + p->name() + " ")) << p->name();
  }
  out_.str("");
  cmd_describe(context(), "test_jelly");
  EXPECT_TRUE(printed("(required)"));
  EXPECT_TRUE(printed("[1 Pa to 1 GPa]"));
  EXPECT_TRUE(printed("[left, right]"));
  EXPECT_TRUE(printed("directly in <scene>"));
  EXPECT_EQ(cmd_describe(context(), "test_jely"), 2);
  EXPECT_EQ(err_.str(), "error: there is no element <test_jely>; did you mean <test_jelly>?\n");
}

TEST_F(Commands, DocsHaveAPagePerElement) {
  EXPECT_EQ(cmd_docs(context(), folder_ / "a" / "b"), 0);
  for (const auto* info : registry_.all())
    EXPECT_TRUE(fs::exists(folder_ / "a" / "b" / (info->element + ".md"))) << info->element;
  std::ifstream in(folder_ / "a" / "b" / "test_jelly.md");
  const std::string page{std::istreambuf_iterator<char>(in), {}};
  EXPECT_NE(page.find("| `young` | pressure in Pa, kPa, MPa, mmHg | **required** | 1 Pa to 1 GPa | Young's modulus "
                      "&lt;of the tissue> |"),
            std::string::npos)
      << page;
  EXPECT_NE(page.find("[test_inner](test_inner.md)"), std::string::npos) << page;
  write("file", "");
  EXPECT_EQ(cmd_docs(context(), folder_ / "file"), 1);
}

TEST_F(Commands, DocsShowTheExampleOfThePlugin) {
  fs::create_directories(folder_ / "plugins" / "jelly_plugin");
  write("plugins/jelly_plugin/example.xml", "<scene title=\"the example\"/>\n");
  EXPECT_EQ(cmd_docs(context(), folder_ / "d", folder_ / "plugins"), 0);
  std::ifstream in(folder_ / "d" / "test_jelly.md");
  const std::string page{std::istreambuf_iterator<char>(in), {}};
  EXPECT_NE(page.find("```xml\n<scene title=\"the example\"/>\n```"), std::string::npos) << page;
}

TEST_F(Commands, SchemaAgreesWithTheLoader) {
  if (std::system("xmllint --version >/dev/null 2>&1") != 0)
    GTEST_SKIP() << "xmllint (package libxml2-utils) is not installed";
  const fs::path xsd = folder_ / "s.xsd";
  ASSERT_EQ(cmd_schema(context(), xsd), 0);
  const auto valid = [&](const std::string& text) {
    const auto file = write("x.xml", text);
    const std::string command = "xmllint --noout --schema '" + xsd.string() + "' '" + file.string() + "' >'" +
                                (folder_ / "log").string() + "' 2>&1";
    const int status = std::system(command.c_str());
    std::ifstream in(folder_ / "log");
    const std::string log{std::istreambuf_iterator<char>(in), {}};
    EXPECT_EQ(log.find("regexp"), std::string::npos) << log;
    EXPECT_EQ(log.find("Schemas parser error"), std::string::npos) << log;
    return status == 0;
  };
  const char* good[] = {
      "<scene/>",
      "<scene title=\"t\" time_step=\"$h\"><variable name=\"h\" value=\"20 ms\"/><test_jelly id=\"a\" young=\"2.1kPa\" "
      "side=\"right\" torque=\"1 N  mm\" at=\"1 -2 3e0 mm\"/></scene>",
      "<scene><test_jelly id=\"b\" young=\"93 mmHg\" unit=\"cm\" others=\"b "
      "c\"><test_inner/><test_inner/></test_jelly><test_jelly id=\"c\" young=\"1 GPa\"/></scene>",
      "<scene gravity=\"0 0 -9.81 m/s2\" seed=\"3\"/>",
  };
  for (const char* text : good) {
    EXPECT_TRUE(valid(text)) << text;
    EXPECT_EQ(cmd_check(context(), {folder_ / "x.xml"}), 0) << err_.str();
  }
  const char* bad[] = {
      "<scene><test_jelly/></scene>",
      "<scene><test_jelly yung=\"1 Pa\" young=\"1 Pa\"/></scene>",
      "<scene><test_jelly young=\"1 N\"/></scene>",
      "<scene><test_jelly young=\"1\"/></scene>",
      "<scene><test_jelly young=\"0,5 Pa\"/></scene>",
      "<scene><test_jelly young=\"1 Pa\" side=\"up\"/></scene>",
      "<scene><test_jelly young=\"1 Pa\" at=\"1 2 mm\"/></scene>",
      "<scene><test_jelly young=\"1 Pa\" unit=\"inch\"/></scene>",
      "<scene><test_inner/></scene>",
      "<scene><nothing/></scene>",
      "<scene seed=\"1.5\"/>",
      "<scene>text</scene>",
      "<scene><include/></scene>",
  };
  for (const char* text : bad) {
    EXPECT_FALSE(valid(text)) << text;
    EXPECT_EQ(cmd_check(context(), {folder_ / "x.xml"}), 2) << text;
  }
  EXPECT_EQ(cmd_schema(context(), folder_ / "no" / "such" / "folder.xsd"), 1);
}

}  // namespace
}  // namespace insula
