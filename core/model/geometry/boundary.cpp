// SPDX-License-Identifier: GPL-3.0-or-later
// The boundary of a tetrahedral mesh: the faces that belong to one tetrahedron only.
#include <algorithm>

#include "core/model/mesh.h"

namespace insula {

std::vector<std::array<int, 3>> boundary_triangles(const TetMesh& mesh) {
  // Faces of a positively oriented tetrahedron, counter-clockwise from outside.
  static constexpr int corner[4][3] = {{1, 2, 3}, {0, 3, 2}, {0, 1, 3}, {0, 2, 1}};
  struct Face {
    int middle, last;  // of its nodes in ascending order; the first is that of the bucket
    std::size_t number;
    bool operator==(const Face& f) const { return middle == f.middle && last == f.last; }
  };
  const auto face = [&](std::size_t number) {
    const auto& t = mesh.tets[number / 4];
    const int* c = corner[number % 4];
    return std::array<int, 3>{t[c[0]], t[c[1]], t[c[2]]};
  };
  // Faces of the same smallest node in one bucket; there are few in each.
  std::vector<std::size_t> start(mesh.nodes.size() + 1, 0);
  for (std::size_t i = 0; i < 4 * mesh.tets.size(); ++i) {
    const auto f = face(i);
    ++start[std::size_t(std::min({f[0], f[1], f[2]})) + 1];
  }
  for (std::size_t i = 0; i < mesh.nodes.size(); ++i) start[i + 1] += start[i];
  std::vector<Face> faces(4 * mesh.tets.size());
  std::vector<std::size_t> fill(start.begin(), start.end() - 1);
  for (std::size_t i = 0; i < faces.size(); ++i) {
    auto f = face(i);
    std::sort(f.begin(), f.end());
    faces[fill[std::size_t(f[0])]++] = {f[1], f[2], i};
  }
  std::vector<std::size_t> alone;
  for (std::size_t n = 0; n < mesh.nodes.size(); ++n) {
    const auto begin = faces.begin() + std::ptrdiff_t(start[n]), end = faces.begin() + std::ptrdiff_t(start[n + 1]);
    for (auto f = begin; f != end; ++f)
      if (std::count(begin, end, *f) == 1) alone.push_back(f->number);
  }
  std::sort(alone.begin(), alone.end());
  std::vector<std::array<int, 3>> out;
  out.reserve(alone.size());
  for (std::size_t number : alone) out.push_back(face(number));
  return out;
}

}  // namespace insula
