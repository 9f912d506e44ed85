// SPDX-License-Identifier: GPL-3.0-or-later
// A table on its way into a file, row by row, as CSV (RFC 4180) or as a JSON list of objects.
#pragma once
#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

namespace insula {

class TableFile {
 public:
  using Json = nlohmann::ordered_json;
  /// folder/name.format, with format "csv" or "json".
  TableFile(const std::filesystem::path& folder, const std::string& name, const std::string& format,
            std::vector<std::string> columns);
  /// A value for each column: a number, a text or null.
  void row(const std::vector<Json>& values);
  /// Returns the file. Throws InputError if it could not be written.
  std::filesystem::path close();

 private:
  std::filesystem::path file_;
  std::ofstream out_;
  bool json_;
  std::vector<std::string> columns_;
  std::size_t rows_ = 0;
};

}  // namespace insula
