// SPDX-License-Identifier: GPL-3.0-or-later
// Every curriculum of this folder is wrong; its .expected file says what must be reported: one line an error, each a
// part of one printed line, and nothing more may be printed. The scenes in scenes/ are small, so that a check is quick.
#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <sstream>

#include "tools/workbench/workbench.h"

namespace insula {
namespace {
namespace fs = std::filesystem;

const fs::path folder = fs::path(INSULA_SOURCE_DIR) / "tests" / "curricula_bad";

std::vector<std::string> lines_of(std::istream& in) {
  std::vector<std::string> lines;
  for (std::string line; std::getline(in, line);)
    if (!line.empty()) lines.push_back(line);
  return lines;
}

std::vector<std::string> curriculum_names() {
  std::vector<std::string> names;
  for (const auto& entry : fs::directory_iterator(folder))
    if (entry.path().extension() == ".xml") names.push_back(entry.path().stem().string());
  std::sort(names.begin(), names.end());
  return names;
}

class BadCurriculum : public testing::TestWithParam<std::string> {};

TEST_P(BadCurriculum, IsReportedAsExpected) {
  Registry registry;
  register_builtin(registry);
  std::ostringstream out, err;
  EXPECT_EQ(cmd_check({registry, out, err}, {folder / (GetParam() + ".xml")}), 2);
  EXPECT_EQ(out.str(), "");
  std::string text = err.str();
  const std::string prefix = folder.generic_string() + "/";
  for (auto at = text.find(prefix); at != std::string::npos; at = text.find(prefix, at)) text.erase(at, prefix.size());
  std::istringstream stream(text);
  auto printed = lines_of(stream);

  std::ifstream expected_file(folder / (GetParam() + ".expected"));
  ASSERT_TRUE(expected_file) << "no .expected file; printed was:\n" << text;
  const auto expected = lines_of(expected_file);
  ASSERT_FALSE(expected.empty());
  for (const auto& line : expected) {
    const auto found =
        std::find_if(printed.begin(), printed.end(), [&](const auto& p) { return p.find(line) != std::string::npos; });
    if (found == printed.end()) ADD_FAILURE() << "not reported: " << line << "\nprinted:\n" << text;
    else printed.erase(found);
  }
  for (const auto& line : printed) ADD_FAILURE() << "reported, but not expected: " << line;
}

INSTANTIATE_TEST_SUITE_P(Curricula, BadCurriculum, testing::ValuesIn(curriculum_names()),
                         [](const auto& curriculum) { return curriculum.param; });

TEST(BadCurricula, ThereAreManyAndNoExpectationWithoutCurriculum) {
  EXPECT_GE(curriculum_names().size(), 50u);
  for (const auto& entry : fs::directory_iterator(folder))
    if (entry.path().extension() == ".expected") {
      EXPECT_TRUE(fs::exists(fs::path(entry.path()).replace_extension(".xml"))) << entry.path();
    }
}

}  // namespace
}  // namespace insula
