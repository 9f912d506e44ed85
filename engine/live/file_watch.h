// SPDX-License-Identifier: GPL-3.0-or-later
// Detects saved files by polling, since editors write in place, rename, or write twice, and folders may be on any file
// system.
#pragma once
#include <chrono>
#include <cstdint>
#include <filesystem>
#include <vector>

namespace insula {

class FileWatch {
 public:
  using Clock = std::chrono::steady_clock;
  /// `quiet`: time without another change after which a change counts, so that a file is not read while it is written.
  explicit FileWatch(std::chrono::milliseconds quiet) : quiet_(quiet) {}

  /// Watches these from now on. Changes before the call that were not reported are dropped.
  void set(std::vector<std::filesystem::path> files);
  /// True once after each change, when it has been followed by `quiet`.
  bool saved(Clock::time_point now);

 private:
  struct Look {
    std::int64_t time_ns = -1, bytes = -1;  ///< -1: there is no such file
    std::uint64_t node = 0;
    bool operator==(const Look&) const = default;
  };
  std::vector<Look> look() const;

  std::chrono::milliseconds quiet_;
  std::vector<std::filesystem::path> files_;
  std::vector<Look> reported_, last_;
  Clock::time_point changed_{};
};

}  // namespace insula
