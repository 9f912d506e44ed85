// SPDX-License-Identifier: GPL-3.0-or-later
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <fstream>

#include "core/model/formats/file_bytes.h"
#include "tools/case_builder/scan_look.h"

namespace insula::case_builder {
namespace {

template <class T>
void write_as(std::ofstream& out, const std::vector<float>& values) {
  std::vector<T> part;
  for (std::size_t from = 0; from < values.size(); from += part.size()) {
    part.clear();
    const std::size_t n = std::min(values.size() - from, std::size_t(1) << 20);
    for (std::size_t i = 0; i < n; ++i) part.push_back(T(values[from + i]));
    out.write(reinterpret_cast<const char*>(part.data()), std::streamsize(n * sizeof(T)));
  }
}

bool fits(const std::vector<float>& values, float least, float most) {
  return std::all_of(values.begin(), values.end(),
                     [&](float x) { return x >= least && x <= most && x == std::floor(x); });
}

}  // namespace

void write_nameless(const std::filesystem::path& file, const mesh_tool::NiftiVolume& v) {
  const bool bytes = fits(v.value, 0, UINT8_MAX), shorts = bytes || fits(v.value, INT16_MIN, INT16_MAX);
  // MetaImage is left-posterior-superior.
  const auto lps = [&](std::size_t column) {
    return fmt::format("{} {} {}", 0.0 - v.to_world[column], 0.0 - v.to_world[4 + column], v.to_world[8 + column]);
  };
  std::string spacing, axes;
  for (std::size_t a = 0; a < 3; ++a) {
    const double mm = std::hypot(v.to_world[a], v.to_world[4 + a], v.to_world[8 + a]);
    spacing += fmt::format(" {}", mm);
    axes += fmt::format(" {} {} {}", 0.0 - v.to_world[a] / mm, 0.0 - v.to_world[4 + a] / mm, v.to_world[8 + a] / mm);
  }
  std::ofstream out(file, std::ios::binary);
  out << fmt::format(
      "ObjectType = Image\nNDims = 3\nBinaryData = True\nBinaryDataByteOrderMSB = False\nCompressedData = False\n"
      "TransformMatrix ={}\nOffset = {}\nElementSpacing ={}\nDimSize = {} {} {}\nElementType = {}\n"
      "ElementDataFile = LOCAL\n",
      axes, lps(3), spacing, v.size[0], v.size[1], v.size[2],
      bytes    ? "MET_UCHAR"
      : shorts ? "MET_SHORT"
               : "MET_FLOAT");
  if (bytes) write_as<std::uint8_t>(out, v.value);
  else if (shorts) write_as<std::int16_t>(out, v.value);
  else write_as<float>(out, v.value);
  if (!out.flush()) fail(file, "cannot be written: is the disk full?");
}

}  // namespace insula::case_builder
