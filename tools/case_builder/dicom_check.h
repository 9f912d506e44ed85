// SPDX-License-Identifier: GPL-3.0-or-later
// Whether a DICOM file is all there. The library that reads them takes a picture that ends early for one that ends in
// zeros, and aborts on some headers that do.
#pragma once
#include <filesystem>

namespace insula::case_builder {

/// Walks the elements of a file of the DICOM format (one with "DICM" after its preamble; others are left alone) up to
/// its picture. Throws InputError with the file's name when it ends within one, or before the picture. Source: DICOM
/// PS3.5, chapters 7 and A.4; PS3.10, chapter 7.
void check_dicom(const std::filesystem::path& file);

}  // namespace insula::case_builder
