// SPDX-License-Identifier: GPL-3.0-or-later
// A file that is being sent.
#pragma once
#include <filesystem>
#include <utility>

namespace insula::gateway {

/// The file goes with this object, unless it has been moved to another place.
class IncomingFile {
 public:
  explicit IncomingFile(std::filesystem::path path) : path_(std::move(path)) {}
  ~IncomingFile() {
    std::error_code ignored;
    std::filesystem::remove(path_, ignored);
  }
  IncomingFile(const IncomingFile&) = delete;
  IncomingFile& operator=(const IncomingFile&) = delete;
  const std::filesystem::path& path() const { return path_; }

 private:
  std::filesystem::path path_;
};

}  // namespace insula::gateway
