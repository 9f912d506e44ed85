// SPDX-License-Identifier: GPL-3.0-or-later
// Files that are replaced in one go: a crash leaves the old text or the new one.
#pragma once
#include <filesystem>
#include <fstream>
#include <string_view>

namespace insula::gateway {

/// Whether the file has the text now. The text is first written beside it, to NAME.part.
inline bool replace_file(const std::filesystem::path& file, std::string_view text) {
  const std::filesystem::path part = file.string() + ".part";
  std::ofstream out(part, std::ios::binary | std::ios::trunc);
  out << text;
  out.close();
  std::error_code error;
  if (out) std::filesystem::rename(part, file, error);
  if (out && !error) return true;
  std::filesystem::remove(part, error);
  return false;
}

}  // namespace insula::gateway
