// SPDX-License-Identifier: GPL-3.0-or-later
// How a file of the DICOM format begins.
#pragma once
#include <string_view>

namespace insula {

/// Whether "DICM" stands after a preamble of 128 bytes (PS3.10, chapter 7.1). bytes: the file's first 132 at least.
inline bool is_dicom_file(std::string_view bytes) { return bytes.size() >= 132 && bytes.substr(128, 4) == "DICM"; }

}  // namespace insula
