// SPDX-License-Identifier: GPL-3.0-or-later
// The boundary of a tetrahedral mesh: the faces that belong to one tetrahedron only.
#include <algorithm>

#include "core/model/mesh.h"

namespace insula {

std::vector<std::array<int, 3>> boundary_triangles(const TetMesh& mesh) {
  // Faces of a positively oriented tetrahedron, counter-clockwise from outside.
  static constexpr int corner[4][3] = {{1, 2, 3}, {0, 3, 2}, {0, 1, 3}, {0, 2, 1}};
  struct Face {
    std::array<int, 3> key;
    std::size_t number;
  };
  std::vector<Face> faces;
  faces.reserve(4 * mesh.tets.size());
  const auto face = [&](std::size_t number) {
    const auto& t = mesh.tets[number / 4];
    const int* c = corner[number % 4];
    return std::array<int, 3>{t[c[0]], t[c[1]], t[c[2]]};
  };
  for (std::size_t i = 0; i < 4 * mesh.tets.size(); ++i) {
    auto key = face(i);
    std::sort(key.begin(), key.end());
    faces.push_back({key, i});
  }
  std::sort(faces.begin(), faces.end(),
            [](const Face& a, const Face& b) { return a.key != b.key ? a.key < b.key : a.number < b.number; });
  std::vector<std::size_t> alone;
  for (std::size_t i = 0; i < faces.size();) {
    std::size_t j = i + 1;
    while (j < faces.size() && faces[j].key == faces[i].key) ++j;
    if (j == i + 1) alone.push_back(faces[i].number);
    i = j;
  }
  std::sort(alone.begin(), alone.end());
  std::vector<std::array<int, 3>> out;
  out.reserve(alone.size());
  for (std::size_t number : alone) out.push_back(face(number));
  return out;
}

}  // namespace insula
