// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/case_builder/cell_surface.h"

#include <algorithm>

#include "core/model/formats/file_bytes.h"

namespace insula::case_builder {
namespace {

constexpr std::size_t most_cells = 5'000'000;

using Faces = std::vector<std::array<int, 4>>;  // of corners; -1: a triangle

/// Of VTK's linear cells, looking outwards ("VTK File Formats", figure 2; vtkWedge turns its triangles inwards).
const Faces& faces_of(int corners) {
  static const Faces tetrahedron{{0, 1, 3, -1}, {1, 2, 3, -1}, {2, 0, 3, -1}, {0, 2, 1, -1}},
      pyramid{{0, 3, 2, 1}, {0, 1, 4, -1}, {1, 2, 4, -1}, {2, 3, 4, -1}, {3, 0, 4, -1}},
      wedge{{0, 1, 2, -1}, {3, 5, 4, -1}, {0, 3, 4, 1}, {1, 4, 5, 2}, {2, 5, 3, 0}},
      hexahedron{{0, 4, 7, 3}, {1, 2, 6, 5}, {0, 1, 5, 4}, {3, 7, 6, 2}, {0, 3, 2, 1}, {4, 5, 6, 7}};
  switch (corners) {
    case 4: return tetrahedron;
    case 5: return pyramid;
    case 6: return wedge;
    default: return hexahedron;
  }
}

void add_triangles(const std::array<int, 4>& key, bool turned, TriMesh& out) {
  const auto [least, low, high, opposite] = key;
  const int next = turned ? high : low, last = turned ? low : high;
  if (opposite < 0) return out.triangles.push_back({least, next, last});
  out.triangles.push_back({least, next, opposite});
  out.triangles.push_back({least, opposite, last});
}

}  // namespace

int CellSurface::corner(std::int64_t i) const {
  if (i < 0 || std::uint64_t(i) >= points_.size())
    fail(file_, "a cell names point " + std::to_string(i) + " of " + std::to_string(points_.size()));
  return int(i);
}

CellSurface::Face CellSurface::face(std::array<int, 4> c) {
  const bool triangle = c[3] < 0;
  const auto end = c.begin() + (triangle ? 3 : 4);
  std::rotate(c.begin(), std::min_element(c.begin(), end), end);
  const int next = c[1], last = triangle ? c[2] : c[3], opposite = triangle ? -1 : c[2];
  return {{c[0], std::min(next, last), std::max(next, last), opposite}, next > last};
}

void CellSurface::add_face(const std::int64_t* corners, int count) {
  alone_.push_back(
      face({corner(corners[0]), corner(corners[1]), corner(corners[2]), count > 3 ? corner(corners[3]) : -1}));
}

void CellSurface::add_volume(const std::int64_t* corners, int count) {
  if (++cells_ > most_cells)
    fail(file_, "has more than " + std::to_string(most_cells) +
                    " cells: write its surface as a file of its own, or cut out the region around the aneurysm");
  std::array<int, 8> c{};
  for (int k = 0; k < count; ++k) c[std::size_t(k)] = corner(corners[k]);
  if (count == 4) {
    const Vec3& a = points_[std::size_t(c[0])];
    const auto edge = [&](std::size_t k) -> Vec3 { return points_[std::size_t(c[k])] - a; };
    if (edge(1).cross(edge(2)).dot(edge(3)) < 0) std::swap(c[0], c[1]);
  }
  for (const std::array<int, 4>& f : faces_of(count)) {
    const auto at = [&](std::size_t k) { return f[k] < 0 ? -1 : c[std::size_t(f[k])]; };
    of_volumes_.push_back(face({at(0), at(1), at(2), at(3)}));
  }
}

TriMesh CellSurface::surface() {
  TriMesh out;
  std::sort(of_volumes_.begin(), of_volumes_.end(), [](const Face& a, const Face& b) { return a.key < b.key; });
  for (std::size_t k = 0, next = 0; k < of_volumes_.size(); k = next) {
    while (next < of_volumes_.size() && of_volumes_[next].key == of_volumes_[k].key) ++next;
    if (next - k > 2) fail(file_, "has a face between " + std::to_string(next - k) + " cells");
    if (next - k == 1) add_triangles(of_volumes_[k].key, of_volumes_[k].turned, out);
  }
  if (of_volumes_.empty())
    for (const Face& f : alone_) add_triangles(f.key, f.turned, out);
  if (out.triangles.empty()) fail(file_, "holds no cells that make up a surface or a volume");
  std::vector<int> place(points_.size(), -1);
  for (std::array<int, 3>& t : out.triangles)
    for (int& i : t) {
      int& at = place[std::size_t(i)];
      if (at < 0) at = int(out.vertices.size()), out.vertices.push_back(points_[std::size_t(i)]);
      i = at;
    }
  return out;
}

}  // namespace insula::case_builder
