// SPDX-License-Identifier: GPL-3.0-or-later
// Every scene of this folder is wrong (expected_messages.h). Hostile files too big to keep are made here.
#include <gtest/gtest.h>
#include <unistd.h>

#include <cstdlib>
#include <ctime>
#include <filesystem>
#include <fstream>
#include <sstream>

#include "core/scene/loader.h"
#include "tests/scenes_bad/expected_messages.h"
#include "tools/workbench/workbench.h"

namespace insula {
namespace {
namespace fs = std::filesystem;

const fs::path folder = fs::path(INSULA_SOURCE_DIR) / "tests" / "scenes_bad";

class BadScene : public testing::TestWithParam<std::string> {};

TEST_P(BadScene, IsReportedAsExpected) { test::expect_reported(folder, GetParam()); }

INSTANTIATE_TEST_SUITE_P(Scenes, BadScene, testing::ValuesIn(test::xml_names(folder)),
                         [](const auto& scene) { return scene.param; });

TEST(BadScenes, ThereAreManyAndNoExpectationWithoutScene) {
  EXPECT_GE(test::xml_names(folder).size(), 60u);
  test::expect_a_file_for_each_expectation(folder);
}

// --- hostile files, made here ---------------------------------------------------------------------------------------

class Hostile : public testing::Test {
 protected:
  void SetUp() override {
    register_builtin(registry_);
    file_ = fs::path(testing::TempDir()) / ("insula_hostile_" + std::to_string(::getpid()) + ".xml");
  }
  void TearDown() override { fs::remove(file_); }
  /// Messages about a file of this text, without its folder.
  std::string check(const std::string& text) {
    std::ofstream(file_, std::ios::binary) << text;
    std::ostringstream out, err;
    status_ = cmd_check({registry_, out, err}, {file_});
    std::string messages = err.str();
    const std::string name = file_.generic_string();
    for (auto at = messages.find(name); at != std::string::npos; at = messages.find(name))
      messages.replace(at, name.size(), "f");
    return messages;
  }
  static std::string repeat(std::string_view piece, std::size_t bytes) {
    std::string text;
    text.reserve(bytes + piece.size());
    while (text.size() < bytes) text += piece;
    return text;
  }
  Registry registry_;
  fs::path file_;
  int status_ = 0;
};

TEST_F(Hostile, HundredMegabytesOfNesting) {
  EXPECT_EQ(check(repeat("<a>", 100u << 20)), "f: error: the file is larger than 16 MiB\n");
  EXPECT_EQ(status_, 2);
}

TEST_F(Hostile, DeepNestingOfAllowedSize) {
  EXPECT_EQ(check(repeat("<exercise title=\"t\">", 15u << 20)),
            "f:1:1281: error: elements are nested more than 64 deep\n");
}

TEST_F(Hostile, MillionsOfElements) {
  EXPECT_NE(check("<scene>" + repeat("<obstacle/>", 15u << 20) + "</scene>").find("more than 100000 elements"),
            std::string::npos);
}

TEST_F(Hostile, OneEndlessValueOrName) {
  EXPECT_NE(
      check("<scene title=\"" + repeat("x", 15u << 20) + "\"/>").find("f:1:15: error: the value is longer than 64 KiB"),
      std::string::npos);
  EXPECT_NE(check("<" + repeat("x", 15u << 20) + "/>").find("is too long"), std::string::npos);
}

TEST_F(Hostile, ManyAttributes) {
  std::string text = "<scene";
  for (int i = 0; i < 100'000; ++i) text += " a" + std::to_string(i) + "=\"\"";
  EXPECT_NE(check(text + "/>").find("more than 64 attributes"), std::string::npos);
}

/// A scene of `count` elements; '#' in a pattern is the element's number. As many good ones stand before them.
std::string many(const char* good, const char* bad, int count) {
  std::string text = "<scene>\n";
  for (const char* pattern : {good, bad})
    for (int i = 0; *pattern != 0 && i < count; ++i) {
      for (const char* p = pattern; *p != 0; ++p) *p == '#' ? text += std::to_string(i) : text += *p;
      text += '\n';
    }
  return text + "</scene>";
}

/// 99,000 errors: the first hundred are shown and the others counted. Ten times as many errors take ten times as long,
/// within what a busy machine adds.
TEST_F(Hostile, NinetyNineThousandErrorsOfEachKind) {
  struct Case {
    const char *what, *element, *good;
  };
  for (const Case& c :
       {Case{"unknown element", "<obstacel id=\"a#\"/>", ""},
        Case{"unknown parameter", "<obstacle id=\"a#\" foo=\"1\"/>", ""},
        Case{"unknown id", "<contact between=\"b# c#\"/>", "<obstacle id=\"a#\"/>"},
        Case{"one id", "<obstacle id=\"a\"/>", ""},
        Case{"unknown variable", "<obstacle id=\"$w#\"/>", "<variable name=\"v#\" value=\"1\"/>"},
        Case{"settings again", "<solver/>", "<obstacle/>"}, Case{"missing part", "<include file=\"no#.xml\"/>", ""}}) {
    SCOPED_TRACE(c.what);
    const int count = *c.good != 0 ? 49'500 : 99'000;
    // Processor time: a tenth of the errors, and all of them.
    const std::string few_text = many(c.good, c.element, count / 10), text = many(c.good, c.element, count);
    const std::clock_t began = std::clock();
    EXPECT_FALSE(load_scene_text(few_text, file_, registry_).ok());
    const std::clock_t between = std::clock();
    const auto result = load_scene_text(text, file_, registry_);
    EXPECT_LT(double(std::clock() - between), 40 * double(between - began));
    EXPECT_FALSE(result.ok());
    ASSERT_EQ(result.diagnostics.all().size(), 101u);
    const std::string last = result.diagnostics.all().back().text;
    ASSERT_TRUE(last.starts_with("and ")) << last;
    EXPECT_GE(std::atoi(last.c_str() + 4), count - 101) << last;
  }
}

TEST_F(Hostile, CutAnywhere) {
  const std::string whole =
      "<?xml version=\"1.0\"?>\n<scene title=\"a\">\n  <!-- c -->\n  <solver max_sweeps=\"10\"/>\n</scene>";
  for (std::size_t n = 0; n < whole.size(); ++n) {
    EXPECT_NE(check(whole.substr(0, n)).find(": error: "), std::string::npos) << n;
    EXPECT_EQ(status_, 2) << n;
  }
  EXPECT_EQ(check(whole), "");
  EXPECT_EQ(status_, 0);
}

TEST_F(Hostile, EveryByteValueSomewhere) {
  for (int byte = 0; byte < 256; ++byte) {
    std::string text = "<scene title=\"a?\"/>";
    text[text.find('?')] = static_cast<char>(byte);
    const std::string messages = check(text);
    const bool fine = byte >= 0x20 && byte < 0x80 && byte != '"' && byte != '<' && byte != '&' && byte != '$';
    const bool blank = byte == '\t' || byte == '\n' || byte == '\r';
    EXPECT_EQ(status_, fine || blank ? 0 : 2) << byte << ": " << messages;
  }
}

TEST_F(Hostile, OtherEncodings) {
  std::string wide;
  for (char c : std::string("<scene/>")) wide += std::string(1, c) + '\0';
  EXPECT_NE(check(wide).find("written in UTF-16; save it as UTF-8"), std::string::npos);
  EXPECT_NE(check("\xFF\xFE" + wide).find("written in UTF-16; save it as UTF-8"), std::string::npos);
}

// --- what looks odd and is right ------------------------------------------------------------------------------------

TEST_F(Hostile, GoodEdges) {
  for (const char* text : {
           "<scene/>",
           "\xEF\xBB\xBF<scene/>",
           "<?xml version='1.0' encoding='utf-8' standalone='yes'?>\r\n<scene></scene>\r\n",
           "<scene title=\"\xE8\x84\xB3 &lt;&amp;&gt; &#228; $$5\"/>",
           "<scene title=''/>",
           "<scene time_step=\" 1e-2s \" seed=\"+7\" gravity=\" 0   0\t-9.81 m/s2\"/>",
           "<scene time_step=\"50 ms\"/>",
           "<scene time_step=\"0.001 s\"/>",
           "<!-- before --><scene><!-- inside --></scene><!-- after -->",
           "<?xml-model href=\"insula.xsd\"?><scene/>",
           "<scene xmlns:xsi=\"http://www.w3.org/2001/XMLSchema-instance\" "
           "xsi:noNamespaceSchemaLocation=\"insula.xsd\"/>",
           "<scene><obstacle id=\"a.b-c_1\"/><obstacle id=\"\xC3\xA4\"/></scene>",
           "<scene><variable name=\"h\" value=\"20\"/><variable name=\"u\" value=\"ms\"/><solver/></scene>",
           "<scene time_step=\"${h}${u}\"><variable name=\"h\" value=\"20\"/><variable name=\"u\" "
           "value=\"ms\"/></scene>",
       }) {
    const std::string messages = check(text);
    EXPECT_EQ(status_, 0) << text << "\n" << messages;
    EXPECT_EQ(messages.find("error"), std::string::npos) << messages;
  }
}

}  // namespace
}  // namespace insula
