// SPDX-License-Identifier: GPL-3.0-or-later
// Files that are replaced in one go: a crash leaves the old text or the new one.
#pragma once
#include <filesystem>
#include <fstream>
#include <string_view>

namespace insula::gateway {

/// Whether the file has the text now. The text is first written beside it, to NAME.part. secret: only its owner may
/// read it.
inline bool replace_file(const std::filesystem::path& file, std::string_view text, bool secret = false) {
  namespace fs = std::filesystem;
  const fs::path part = file.string() + ".part";
  std::ofstream out(part, std::ios::binary | std::ios::trunc);
  std::error_code error;
  if (secret) fs::permissions(part, fs::perms::owner_read | fs::perms::owner_write, error);
  if (!error) out << text;
  out.close();
  if (out && !error) fs::rename(part, file, error);
  if (out && !error) return true;
  fs::remove(part, error);
  return false;
}

}  // namespace insula::gateway
