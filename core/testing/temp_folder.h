// SPDX-License-Identifier: GPL-3.0-or-later
// A temporary folder for one test.
#pragma once
#include <filesystem>
#include <fstream>
#include <random>
#include <string>

namespace insula::test_files {

/// A folder that is removed by the destructor.
class TempFolder {
 public:
  TempFolder() {
    std::random_device random;
    do {
      path_ = std::filesystem::temp_directory_path() / ("insula_test_" + std::to_string(random()));
    } while (!std::filesystem::create_directory(path_));
  }
  ~TempFolder() {
    std::error_code ignored;
    std::filesystem::remove_all(path_, ignored);
  }
  TempFolder(const TempFolder&) = delete;
  TempFolder& operator=(const TempFolder&) = delete;
  std::filesystem::path path() const { return path_; }
  /// Writes a file below the folder; returns its path.
  std::filesystem::path write(const std::string& name, const std::string& bytes) const {
    std::filesystem::create_directories((path_ / name).parent_path());
    std::filesystem::remove(path_ / name);  // some file systems flush a file that is cut to nothing and written again
    std::ofstream out(path_ / name, std::ios::binary | std::ios::trunc);
    out << bytes;
    return path_ / name;
  }

 private:
  std::filesystem::path path_;
};

}  // namespace insula::test_files
