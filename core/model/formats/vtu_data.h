// SPDX-License-Identifier: GPL-3.0-or-later
// The numbers of one DataArray of a VTK XML file, for every encoding.
#pragma once
#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include "core/model/formats/vtk_cells.h"

namespace insula {

struct VtuFormat {
  bool swap = false;          ///< the file's byte order is not the machine's
  bool header64 = false;      ///< header_type UInt64
  bool zlib = false;          ///< compressor vtkZLibDataCompressor
  bool appended_raw = true;   ///< encoding of AppendedData; false: base64
  std::string_view appended;  ///< bytes after the underscore
};

struct VtuArray {
  std::string name, type, format;
  std::size_t offset = 0;  ///< into the appended data
  std::string text;        ///< inline content
};

/// Reads integers and real numbers. `expected` is the count that the file announces (negative: any). Throws InputError.
std::vector<double> vtu_numbers(const std::filesystem::path& file, const VtuFormat& format, const VtuArray& array,
                                std::int64_t expected);

}  // namespace insula
