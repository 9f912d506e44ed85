// SPDX-License-Identifier: GPL-3.0-or-later
// A text for the viewers that another process writes to a file: the errors of a saved scene.
#pragma once
#include <chrono>
#include <filesystem>
#include <string>

namespace insula {

class Notice {
 public:
  /// Longer texts are cut at the end of a line, so that the message stays small.
  static constexpr std::size_t max_bytes = 8 * 1024;
  explicit Notice(std::filesystem::path file) : file_(std::move(file)) {}

  /// The present text of the file, read every quarter of a second; empty without a file.
  const std::string& text();

 private:
  std::filesystem::path file_;
  std::string text_;
  std::chrono::steady_clock::time_point next_{};
  std::filesystem::file_time_type read_{};
};

/// Writes a text to the file, completely or not at all. Returns whether it could be written.
bool leave_notice(const std::filesystem::path& file, const std::string& text);

}  // namespace insula
