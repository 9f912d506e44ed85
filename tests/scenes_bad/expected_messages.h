// SPDX-License-Identifier: GPL-3.0-or-later
// Wrong files with a file beside each that says what must be reported: one line an error, each a part of one printed
// line, and nothing more may be printed.
#pragma once
#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <sstream>
#include <string>
#include <vector>

#include "core/registry/registry.h"
#include "tools/workbench/workbench.h"

namespace insula::test {

inline std::vector<std::string> lines_of(std::istream& in) {
  std::vector<std::string> lines;
  for (std::string line; std::getline(in, line);)
    if (!line.empty()) lines.push_back(line);
  return lines;
}

/// Stems of the XML files of a folder, sorted.
inline std::vector<std::string> xml_names(const std::filesystem::path& folder) {
  std::vector<std::string> names;
  for (const auto& entry : std::filesystem::directory_iterator(folder))
    if (entry.path().extension() == ".xml") names.push_back(entry.path().stem().string());
  std::sort(names.begin(), names.end());
  return names;
}

/// Checks folder/name.xml, and compares what is printed with folder/name.expected.
inline void expect_reported(const std::filesystem::path& folder, const std::string& name) {
  Registry registry;
  register_builtin(registry);
  std::ostringstream out, err;
  EXPECT_EQ(cmd_check({registry, out, err}, {folder / (name + ".xml")}), 2);
  EXPECT_EQ(out.str(), "");
  std::string text = err.str();
  const std::string prefix = folder.generic_string() + "/";
  for (auto at = text.find(prefix); at != std::string::npos; at = text.find(prefix, at)) text.erase(at, prefix.size());
  std::istringstream stream(text);
  auto printed = lines_of(stream);

  std::ifstream expected_file(folder / (name + ".expected"));
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

/// Every expectation has its XML file.
inline void expect_a_file_for_each_expectation(const std::filesystem::path& folder) {
  for (const auto& entry : std::filesystem::directory_iterator(folder))
    if (entry.path().extension() == ".expected") {
      EXPECT_TRUE(std::filesystem::exists(std::filesystem::path(entry.path()).replace_extension(".xml")))
          << entry.path();
    }
}

}  // namespace insula::test
