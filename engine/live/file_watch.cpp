// SPDX-License-Identifier: GPL-3.0-or-later
#include "engine/live/file_watch.h"

#include <sys/stat.h>

namespace insula {

std::vector<FileWatch::Look> FileWatch::look() const {
  std::vector<Look> out(files_.size());
  for (std::size_t i = 0; i < files_.size(); ++i) {
    struct stat s {};
    if (::stat(files_[i].c_str(), &s) != 0) continue;
    out[i] = {s.st_mtim.tv_sec * 1'000'000'000 + s.st_mtim.tv_nsec, s.st_size, s.st_ino};
  }
  return out;
}

void FileWatch::set(std::vector<std::filesystem::path> files) {
  files_ = std::move(files);
  reported_ = last_ = look();
}

bool FileWatch::saved(Clock::time_point now) {
  std::vector<Look> seen = look();
  if (seen != last_) {
    last_ = std::move(seen);
    changed_ = now;
    return false;
  }
  if (last_ == reported_ || now - changed_ < quiet_) return false;
  reported_ = last_;
  return true;
}

}  // namespace insula
