// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/case_builder/crop.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "core/model/formats/file_bytes.h"

namespace insula::case_builder {

mesh_tool::NiftiVolume cropped(const std::filesystem::path& file, const mesh_tool::NiftiVolume& v, const Point& middle,
                               double mm) {
  mesh_tool::NiftiVolume out;
  out.to_world = v.to_world, out.from_world = v.from_world;
  std::array<int, 3> from{};
  for (std::size_t a = 0; a < 3; ++a) {
    double at = v.from_world[4 * a + 3];
    for (std::size_t r = 0; r < 3; ++r) at += v.from_world[4 * a + r] * middle[r];
    const double half = mm / std::hypot(v.to_world[a], v.to_world[4 + a], v.to_world[8 + a]);
    from[a] = int(std::clamp(std::ceil(at - half), 0.0, double(v.size[a])));
    const int end = int(std::clamp(std::floor(at + half) + 1, 0.0, double(v.size[a])));
    out.size[a] = end - from[a];
    if (out.size[a] < 2)
      fail(file, fmt::format("has no voxels within {:g} mm of the seed ({:.1f}, {:.1f}, {:.1f})", mm, middle[0],
                             middle[1], middle[2]));
  }
  for (std::size_t r = 0; r < 3; ++r) {
    for (std::size_t a = 0; a < 3; ++a) out.to_world[4 * r + 3] += v.to_world[4 * r + a] * from[a];
    out.from_world[4 * r + 3] -= from[r];
  }
  out.value.reserve(std::size_t(out.size[0]) * std::size_t(out.size[1]) * std::size_t(out.size[2]));
  for (int k = 0; k < out.size[2]; ++k)
    for (int j = 0; j < out.size[1]; ++j) {
      const float* row =
          &v.value[std::size_t(from[0]) + std::size_t(v.size[0]) * (std::size_t(from[1] + j) +
                                                                    std::size_t(v.size[1]) * std::size_t(from[2] + k))];
      out.value.insert(out.value.end(), row, row + out.size[0]);
    }
  return out;
}

}  // namespace insula::case_builder
