// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/case_builder/paint.h"

#include <algorithm>
#include <cmath>

#include "core/model/formats/file_bytes.h"

namespace insula::case_builder {
namespace {

using mesh_tool::operator-, mesh_tool::operator+, mesh_tool::operator*, mesh_tool::dot, mesh_tool::norm;

constexpr double least_radius = 0.1, most_radius = 20;  // mm
constexpr std::size_t most_file_bytes = 20'000'000;

void paint_line(const mesh_tool::Grid& grid, mesh_tool::Mask& mask, const Point& a, const Point& b, const Stroke& s) {
  std::array<int, 3> from{}, to{};
  for (std::size_t k = 0; k < 3; ++k) {
    const double low = (std::min(a[k], b[k]) - s.radius_mm - grid.origin[k]) / grid.spacing;
    const double high = (std::max(a[k], b[k]) + s.radius_mm - grid.origin[k]) / grid.spacing;
    from[k] = int(std::clamp(std::ceil(low), 0.0, double(grid.size[k])));
    to[k] = int(std::clamp(std::floor(high) + 1, 0.0, double(grid.size[k])));
  }
  const Point along = b - a;
  const double length2 = dot(along, along);
  for (int k = from[2]; k < to[2]; ++k)
    for (int j = from[1]; j < to[1]; ++j)
      for (int i = from[0]; i < to[0]; ++i) {
        const Point p = grid.point(i, j, k);
        const double share = length2 > 0 ? std::clamp(dot(p - a, along) / length2, 0.0, 1.0) : 0;
        if (norm(p - (a + share * along)) <= s.radius_mm) mask[grid.index(i, j, k)] = !s.erase;
      }
}

}  // namespace

std::vector<Stroke> read_strokes(const std::filesystem::path& file) {
  std::vector<Stroke> out;
  try {
    out = strokes_from_json(Json::parse(read_file_bytes(file, most_file_bytes)));
  } catch (const nlohmann::json::exception&) {
    fail(file, "is no list of strokes: [{\"erase\": false, \"radius_mm\": 1, \"points\": [[X, Y, Z], ...]}, ...]");
  }
  for (const Stroke& s : out) {
    if (!(s.radius_mm >= least_radius && s.radius_mm <= most_radius))
      fail(file, "has a stroke whose radius is not from 0.1 to 20 mm");
    if (s.points.empty()) fail(file, "has a stroke without points");
  }
  return out;
}

void paint(const mesh_tool::Grid& grid, mesh_tool::Mask& mask, const std::vector<Stroke>& strokes) {
  for (const Stroke& s : strokes)
    for (std::size_t k = 0; k < s.points.size(); ++k)
      paint_line(grid, mask, s.points[k == 0 ? 0 : k - 1], s.points[k], s);
}

}  // namespace insula::case_builder
