// SPDX-License-Identifier: GPL-3.0-or-later
// Reads a .zip file that nobody has checked. No file of it is larger than its reader allows, whatever the archive says.
#pragma once
#include <zip.h>

#include <cstdint>
#include <filesystem>
#include <memory>
#include <string>

namespace insula {

struct ZipClosed {
  void operator()(zip_t* z) const { zip_discard(z); }
  void operator()(zip_file_t* f) const { zip_fclose(f); }
};
using ZipArchive = std::unique_ptr<zip_t, ZipClosed>;

/// `kind`: what the file should have been, such as "case". Throws InputError.
ZipArchive opened_zip(const std::filesystem::path& file, int flags, const std::string& kind);

class ZipReader {
 public:
  /// Throws InputError: no archive, no files in it, or more than `most_files`.
  ZipReader(const std::filesystem::path& file, const std::string& kind, std::uint64_t most_files);
  std::uint64_t count() const { return count_; }
  /// As the archive has it: safe to show, not to use as a path.
  std::string name(std::uint64_t file) const;
  /// Throws InputError: damaged, or more bytes than `most`.
  std::string read(std::uint64_t file, std::uint64_t most) const;
  [[noreturn]] void refuse(const std::string& why) const;

 private:
  std::filesystem::path file_;
  ZipArchive zip_;
  std::uint64_t count_ = 0;
};

}  // namespace insula
