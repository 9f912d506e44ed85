// SPDX-License-Identifier: GPL-3.0-or-later
// Includes and variables: what they put together, and how they refuse.
#include "core/scene/expand.h"

#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>

#include "core/base/this_process.h"

namespace insula {
namespace {
namespace fs = std::filesystem;

class Expand : public testing::Test {
 protected:
  void SetUp() override {
    const auto* info = testing::UnitTest::GetInstance()->current_test_info();
    folder_ =
        fs::path(testing::TempDir()) / (std::string("insula_expand_") + info->name() + std::to_string(process_id()));
    fs::remove_all(folder_);
    fs::create_directories(folder_);
  }
  void TearDown() override { fs::remove_all(folder_); }
  void write(const fs::path& name, std::string_view text) {
    fs::create_directories((folder_ / name).parent_path());
    std::ofstream(folder_ / name, std::ios::binary) << text;
  }
  /// Names, attributes and nesting on one line: "scene(a[x=1](b))", then the messages.
  std::string expand(std::string_view text) {
    Diagnostics d;
    scene_ = expand_scene(text, folder_ / "s.xml", d);
    std::string out = scene_.root ? line(*scene_.root) : "";
    std::string messages = d.format();
    const std::string prefix = folder_.generic_string() + "/";
    for (auto at = messages.find(prefix); at != std::string::npos; at = messages.find(prefix))
      messages.erase(at, prefix.size());
    return messages.empty() ? out : messages;
  }
  static std::string line(const Element& e) {
    std::string out = e.name;
    for (const auto& a : e.attributes) out += "[" + a.name + "=" + a.value + "]";
    std::string inner;
    for (const auto& c : e.children) inner += (inner.empty() ? "" : " ") + line(*c);
    return inner.empty() ? out : out + "(" + inner + ")";
  }
  fs::path folder_;
  ExpandedScene scene_;
};

TEST_F(Expand, Variables) {
  EXPECT_EQ(expand(R"(<scene><variable name="x" value="3 mm"/><a v="$x" w="${x}s" d="$$5 $$x"/></scene>)"),
            "scene(a[v=3 mm][w=3 mms][d=$5 $x])");
  EXPECT_EQ(
      expand(R"(<scene t="$x"><a v="$x"/><variable name="x" value="$y$y"/><variable name="y" value="1"/></scene>)"),
      "scene[t=11](a[v=11])");
  EXPECT_EQ(expand(R"(<scene><variable name="x" value=""/><a v="[$x]"/></scene>)"), "scene(a[v=[]])");
}

TEST_F(Expand, WrongVariables) {
  EXPECT_EQ(expand("<scene>\n<variable name=\"width\" value=\"1\"/><a v=\"$widht $width\"/></scene>"),
            "s.xml:2:41: error: unknown variable \"$widht\"; did you mean \"$width\"?\ns.xml:2:17: warning: variable "
            "\"width\" is not used\n");
  EXPECT_EQ(expand("<scene><a v=\"$q\"/></scene>"), "s.xml:1:14: error: unknown variable \"$q\"\n");
  EXPECT_NE(expand("<scene><a v=\"5 $\"/></scene>").find("\"$\" needs the name of a variable"), std::string::npos);
  EXPECT_NE(expand("<scene><a v=\"${x\"/></scene>").find("\"${\" is not closed"), std::string::npos);
  EXPECT_NE(expand("<scene><variable name=\"x\" value=\"$x\"/><a v=\"$x\"/></scene>").find("refers to itself"),
            std::string::npos);
  EXPECT_NE(expand("<scene><variable name=\"x\" value=\"$y\"/><variable name=\"y\" value=\"$x\"/><a v=\"$x\"/></scene>")
                .find("refers to itself"),
            std::string::npos);
  EXPECT_EQ(expand("<scene><variable name=\"x\" value=\"1\"/></scene>"),
            "s.xml:1:24: warning: variable \"x\" is not used\n");
  EXPECT_NE(
      expand("<scene>\n<variable name=\"x\" value=\"1\"/>\n<variable name=\"x\" value=\"2\"/><a v=\"$x\"/></scene>")
          .find("s.xml:3:17: error: variable \"x\" is already defined at line 2"),
      std::string::npos);
  EXPECT_NE(expand("<scene><variable name=\"2x\" value=\"1\"/></scene>").find("cannot be the name of a variable"),
            std::string::npos);
  EXPECT_NE(expand("<scene><variable nam=\"x\" value=\"1\"/></scene>").find("did you mean \"name\"?"),
            std::string::npos);
  EXPECT_NE(expand("<scene><variable name=\"x\"/></scene>").find("<variable> needs parameter \"value\""),
            std::string::npos);
  EXPECT_NE(expand("<scene><a><variable name=\"x\" value=\"1\"/></a></scene>").find("<variable> may not stand in <a>"),
            std::string::npos);
}

TEST_F(Expand, VariablesCannotExplode) {
  std::string text = "<scene><variable name=\"v0\" value=\"0123456789\"/>";
  for (int i = 1; i < 30; ++i) {
    const std::string before = "$v" + std::to_string(i - 1);
    text += "<variable name=\"v" + std::to_string(i) + "\" value=\"" + before + before + before + before + "\"/>";
  }
  EXPECT_NE(expand(text + "<a v=\"$v29\"/></scene>").find("too long after its variables are replaced"),
            std::string::npos);
  std::string chain = "<scene><variable name=\"v0\" value=\"1\"/>";
  for (int i = 1; i < 900; ++i)
    chain += "<variable name=\"v" + std::to_string(i) + "\" value=\"$v" + std::to_string(i - 1) + "\"/>";
  EXPECT_NE(expand(chain + "<a v=\"$v899\"/></scene>").find("more than 32 deep"), std::string::npos);
}

TEST_F(Expand, Includes) {
  write("parts/p.xml", "<part><b/><include file=\"q.xml\"/></part>");
  write("parts/q.xml", "<scene title=\"own\"><c/></scene>");
  EXPECT_EQ(expand("<scene><a/><include file=\"parts/p.xml\"/><d><include file=\"parts/q.xml\"/></d></scene>"),
            "scene(a b c d(c))");
  EXPECT_EQ(scene_.root->children[2]->pos.file, (folder_ / "parts/q.xml").generic_string());
  EXPECT_EQ(scene_.root->children[2]->part->path, fs::canonical(folder_ / "parts/q.xml"));
}

TEST_F(Expand, VariablesAcrossFiles) {
  write("p.xml", "<part><variable name=\"x\" value=\"default\"/><b v=\"$x\"/></part>");
  EXPECT_EQ(expand("<scene><include file=\"p.xml\"/></scene>"), "scene(b[v=default])");
  EXPECT_EQ(expand("<scene><variable name=\"x\" value=\"outer\"/><include file=\"p.xml\"/></scene>"),
            "scene(b[v=outer])");
  EXPECT_EQ(expand("<scene><include file=\"p.xml\"><variable name=\"x\" value=\"one\"/></include><include "
                   "file=\"p.xml\"><variable name=\"x\" value=\"two\"/></include></scene>"),
            "scene(b[v=one] b[v=two])");
  EXPECT_EQ(expand("<scene><variable name=\"x\" value=\"1\"/><include file=\"p.xml\"><variable name=\"x\" "
                   "value=\"${x}0\"/></include></scene>"),
            "scene(b[v=10])");
  // What a part defines stays in the part.
  EXPECT_EQ(expand("<scene><include file=\"p.xml\"/><a v=\"$x\"/></scene>"),
            "s.xml:1:37: error: unknown variable \"$x\"\n");
  EXPECT_EQ(expand("<scene><include file=\"p.xml\"><variable name=\"y\" value=\"1\"/></include></scene>"),
            "s.xml:1:46: warning: variable \"y\" is not used\n");
}

TEST_F(Expand, VariableAsFile) {
  write("p1.xml", "<part><b/></part>");
  EXPECT_EQ(expand("<scene><variable name=\"n\" value=\"1\"/><include file=\"p${n}.xml\"/></scene>"), "scene(b)");
}

TEST_F(Expand, Prefixes) {
  write("p.xml", "<part><include file=\"q.xml\" prefix=\"in_\"/></part>");
  write("q.xml", "<part><c/></part>");
  EXPECT_EQ(expand("<scene><include file=\"p.xml\" prefix=\"out_\"/></scene>"), "scene(c)");
  EXPECT_EQ(scene_.root->children[0]->part->prefixes, (std::vector<std::string>{"out_in_", "out_", ""}));
  EXPECT_NE(expand("<scene><include file=\"q.xml\" prefix=\"a b\"/></scene>")
                .find("s.xml:1:38: error: prefix: \"a b\" may have only"),
            std::string::npos);
}

TEST_F(Expand, WrongIncludes) {
  write("cycle.xml", "<part><include file=\"cycle2.xml\"/></part>");
  write("cycle2.xml", "<part>\n<include file=\"./cycle.xml\"/></part>");
  write("self.xml", "<part><include file=\"self.xml\"/></part>");
  write("broken.xml", "<part><b></part>");
  write("other.xml", "<other/>");
  write("titled.xml", "<part title=\"t\" seed=\"1\"/>");
  fs::create_directories(folder_ / "dir");
  EXPECT_EQ(expand("<scene><include file=\"cycle.xml\"/></scene>"),
            "cycle2.xml:2:16: error: include cycle: cycle.xml -> cycle2.xml -> cycle.xml\n");
  EXPECT_EQ(expand("<scene><include file=\"self.xml\"/></scene>"),
            "self.xml:1:22: error: include cycle: self.xml -> self.xml\n");
  EXPECT_EQ(expand("<scene><include file=\"broken.xml\"/></scene>"),
            "broken.xml:1:10: error: </part> closes <b> of line 1\n");
  EXPECT_EQ(expand("<scene><include file=\"other.xml\"/></scene>"),
            "other.xml:1:1: error: the root of an included file must be <part> or <scene>, not <other>\n");
  EXPECT_EQ(expand("<scene><include file=\"titled.xml\"/></scene>"),
            "titled.xml:1:17: error: <part> has no parameter \"seed\" (it has: title)\n");
  EXPECT_EQ(expand("<scene><include file=\"brokn.xml\"/></scene>"),
            "s.xml:1:23: error: file: \"brokn.xml\" does not exist; did you mean \"broken.xml\"?\n");
  EXPECT_EQ(expand("<scene><include file=\"dir\"/></scene>"), "s.xml:1:23: error: file: \"dir\" is not a file\n");
  EXPECT_EQ(expand("<scene><include/></scene>"), "s.xml:1:8: error: <include> needs parameter \"file\"\n");
  EXPECT_EQ(expand("<scene><include fil=\"self.xml\"/></scene>"),
            "s.xml:1:17: error: <include> has no parameter \"fil\"; did you mean \"file\"?\ns.xml:1:8: error: "
            "<include> needs parameter \"file\"\n");
  EXPECT_EQ(expand("<scene><include file=\"\"/></scene>"),
            "s.xml:1:23: error: file: the value is empty; it must name a file\n");
  EXPECT_NE(expand("<scene><include file=\"/etc/passwd\"/></scene>").find("is an absolute path"), std::string::npos);
  EXPECT_NE(expand("<scene><include file=\"../x.xml\"/></scene>").find("leaves the scene's root folder"),
            std::string::npos);
  EXPECT_NE(expand("<scene><include file=\"/dev/zero\"/></scene>").find("is an absolute path"), std::string::npos);
  EXPECT_NE(expand("<scene><include file=\"titled.xml\"><b/></include></scene>").find("<b> may not stand in <include>"),
            std::string::npos);
}

TEST_F(Expand, IncludesCannotExplode) {
  for (int i = 0; i < 12; ++i) {
    const std::string next = "<include file=\"p" + std::to_string(i + 1) + ".xml\"/>";
    write("p" + std::to_string(i) + ".xml", "<part>" + next + next + next + next + "</part>");
  }
  write("p12.xml", "<part><b/></part>");
  EXPECT_NE(expand("<scene><include file=\"p0.xml\"/></scene>").find("more than 256 inclusions"), std::string::npos);
  for (int i = 0; i < 40; ++i)
    write("d" + std::to_string(i) + ".xml", "<part><include file=\"d" + std::to_string(i + 1) + ".xml\"/></part>");
  EXPECT_NE(expand("<scene><include file=\"d0.xml\"/></scene>").find("included more than 16 deep"), std::string::npos);
}

TEST_F(Expand, NamespacesOfTheRootAreForEditors) {
  EXPECT_EQ(
      expand(
          R"(<scene xmlns:xsi="http://www.w3.org/2001/XMLSchema-instance" xsi:noNamespaceSchemaLocation="insula.xsd"><a/></scene>)"),
      "scene(a)");
}

}  // namespace
}  // namespace insula
