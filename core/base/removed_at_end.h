// SPDX-License-Identifier: GPL-3.0-or-later
// A file or a folder that goes with its owner.
#pragma once
#include <filesystem>
#include <utility>

namespace insula {

/// Removes the path at the end, with all that is in it. What has been moved elsewhere stays; an empty path is nothing.
class RemovedAtEnd {
 public:
  explicit RemovedAtEnd(std::filesystem::path path = {}) : path_(std::move(path)) {}
  ~RemovedAtEnd() {
    std::error_code ignored;
    if (!path_.empty()) std::filesystem::remove_all(path_, ignored);
  }
  RemovedAtEnd(RemovedAtEnd&& other) noexcept : path_(std::exchange(other.path_, {})) {}
  const std::filesystem::path& path() const { return path_; }

 private:
  std::filesystem::path path_;
};

}  // namespace insula
