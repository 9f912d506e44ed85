// SPDX-License-Identifier: GPL-3.0-or-later
#include "engine/sharing/zip_reader.h"

#include <fmt/format.h>

#include "core/base/input_error.h"

namespace insula {
namespace fs = std::filesystem;

ZipArchive opened_zip(const fs::path& file, int flags, const std::string& kind) {
  int code = 0;
  ZipArchive z(zip_open(file.c_str(), flags, &code));
  if (z) return z;
  zip_error_t error;
  zip_error_init_with_code(&error, code);
  const std::string text = zip_error_strerror(&error);
  zip_error_fini(&error);
  throw InputError(file.string() + ": is no " + kind + " (" + text + ")");
}

ZipReader::ZipReader(const fs::path& file, const std::string& kind, std::uint64_t most_files)
    : file_(file), zip_(opened_zip(file, ZIP_RDONLY, kind)) {
  const zip_int64_t count = zip_get_num_entries(zip_.get(), 0);
  if (count < 1 || std::uint64_t(count) > most_files)
    refuse(fmt::format("has {} files; a {} has 1 to {}", count, kind, most_files - 1));
  count_ = std::uint64_t(count);
}

std::string ZipReader::name(std::uint64_t file) const {
  const char* name = zip_get_name(zip_.get(), file, ZIP_FL_ENC_GUESS);
  return name ? name : "";
}

std::string ZipReader::read(std::uint64_t file, std::uint64_t most) const {
  const std::string path = name(file);
  zip_stat_t facts;
  if (zip_stat_index(zip_.get(), file, 0, &facts) != 0 || !(facts.valid & ZIP_STAT_SIZE) || facts.size > most)
    refuse(fmt::format("has the file \"{}\" of more than {} bytes", path, most));
  const std::unique_ptr<zip_file_t, ZipClosed> in(zip_fopen_index(zip_.get(), file, 0));
  if (!in) refuse("has the file \"" + path + "\", which cannot be read: " + zip_strerror(zip_.get()));
  std::string bytes(facts.size + 1, '\0');
  std::uint64_t n = 0;
  while (n < bytes.size()) {
    const zip_int64_t got = zip_fread(in.get(), bytes.data() + n, bytes.size() - n);
    if (got < 0) refuse("is damaged at the file \"" + path + "\"");
    if (got == 0) break;
    n += std::uint64_t(got);
  }
  if (n != facts.size) refuse("is damaged at the file \"" + path + "\"");
  bytes.resize(n);
  return bytes;
}

void ZipReader::refuse(const std::string& why) const { throw InputError(file_.string() + ": " + why); }

}  // namespace insula
