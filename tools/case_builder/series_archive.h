// SPDX-License-Identifier: GPL-3.0-or-later
// A DICOM series in one .zip file. Its images are unpacked under names of our own and go again.
#pragma once
#include "core/base/removed_at_end.h"

namespace insula::case_builder {

/// Unpacks the images into a new folder beside the archive, or among the temporary files where that cannot be written.
/// Other files of the archive are left out. Throws InputError: no archive, no images, too many or too large files.
RemovedAtEnd unpacked_series(const std::filesystem::path& archive);

}  // namespace insula::case_builder
