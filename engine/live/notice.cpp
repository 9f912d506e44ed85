// SPDX-License-Identifier: GPL-3.0-or-later
#include "engine/live/notice.h"

#include <fstream>
#include <iterator>

namespace fs = std::filesystem;

namespace insula {

const std::string& Notice::text() {
  const auto now = std::chrono::steady_clock::now();
  if (file_.empty() || now < next_) return text_;
  next_ = now + std::chrono::milliseconds(250);
  std::error_code ec;
  const auto written = fs::last_write_time(file_, ec);
  if (ec) text_.clear();
  else if (written != read_) {
    read_ = written;
    std::ifstream in(file_, std::ios::binary);
    text_.assign(std::istreambuf_iterator<char>(in), {});
    if (text_.size() > max_bytes) {
      text_.resize(max_bytes);
      text_.erase(text_.rfind('\n') == std::string::npos ? max_bytes : text_.rfind('\n') + 1);
      text_ += "...\n";
    }
  }
  return text_;
}

bool leave_notice(const fs::path& file, const std::string& text) {
  const fs::path beside = file.string() + ".new";
  {
    std::ofstream out(beside, std::ios::binary);
    if (!(out << text << std::flush)) return false;
  }
  std::error_code ec;
  fs::rename(beside, file, ec);
  return !ec;
}

}  // namespace insula
