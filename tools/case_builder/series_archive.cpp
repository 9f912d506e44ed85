// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/case_builder/series_archive.h"

#include <fmt/format.h>
#include <stdlib.h>

#include <fstream>

#include "core/base/input_error.h"
#include "core/model/formats/dicom_mark.h"
#include "engine/sharing/zip_reader.h"

namespace insula::case_builder {
namespace {

namespace fs = std::filesystem;

constexpr std::uint64_t most_files = 5000;
constexpr std::uint64_t most_image_bytes = 1'000'000'000;  // one file may hold all slices
constexpr std::uint64_t most_bytes = 2'000'000'000;
constexpr std::string_view list_of_files = "1.2.840.10008.1.3.10";  // the class of a DICOMDIR (PS3.4)

bool is_image(std::string_view bytes) {
  return is_dicom_file(bytes) && bytes.substr(0, 1024).find(list_of_files) == std::string_view::npos;
}

fs::path new_folder(const fs::path& near) {
  for (const fs::path& in : {near, fs::temp_directory_path()}) {
    std::string name = (in / ".series_XXXXXX").string();
    if (::mkdtemp(name.data())) return name;
  }
  throw InputError(near.string() + ": no folder can be made for the images of the archive");
}

}  // namespace

RemovedAtEnd unpacked_series(const fs::path& archive) {
  const ZipReader zip(archive, "zip of a DICOM series", most_files + 1);
  RemovedAtEnd folder(new_folder(archive.has_parent_path() ? archive.parent_path() : fs::path(".")));
  std::uint64_t bytes = 0;
  int images = 0;
  for (std::uint64_t i = 0; i < zip.count(); ++i) {
    if (zip.name(i).ends_with('/')) continue;
    const std::string image = zip.read(i, most_image_bytes);
    if ((bytes += image.size()) > most_bytes) zip.refuse(fmt::format("holds more than {} bytes", most_bytes));
    if (!is_image(image)) continue;
    std::ofstream out(folder.path() / fmt::format("image_{:04}.dcm", ++images), std::ios::binary);
    if (!out.write(image.data(), std::streamsize(image.size())).flush())
      throw InputError(folder.path().string() + ": cannot be written: is the disk full?");
  }
  if (images == 0) zip.refuse("holds no DICOM images");
  return folder;
}

}  // namespace insula::case_builder
