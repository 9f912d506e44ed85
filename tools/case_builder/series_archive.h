// SPDX-License-Identifier: GPL-3.0-or-later
// A DICOM series in one .zip file. Its images are unpacked under names of our own and go again.
#pragma once
#include <filesystem>

namespace insula::case_builder {

class UnpackedSeries {
 public:
  /// Unpacks the images into a new folder beside the archive, or among the temporary files where that cannot be
  /// written. Other files of the archive are left out. Throws InputError: no archive, no images, too many or too large
  /// files.
  explicit UnpackedSeries(const std::filesystem::path& archive);
  ~UnpackedSeries();
  UnpackedSeries(const UnpackedSeries&) = delete;
  UnpackedSeries& operator=(const UnpackedSeries&) = delete;
  const std::filesystem::path& folder() const { return folder_; }

 private:
  std::filesystem::path folder_;
};

}  // namespace insula::case_builder
