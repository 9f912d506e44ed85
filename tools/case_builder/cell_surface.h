// SPDX-License-Identifier: GPL-3.0-or-later
// The outer surface of a mesh of volume cells, as modellers of blood flow write it.
#pragma once
#include <array>
#include <cstdint>
#include <filesystem>
#include <vector>

#include "core/model/mesh.h"

namespace insula::case_builder {

/// Gathers cells, then gives the faces that belong to one cell only.
class CellSurface {
 public:
  /// Points may be outside of the cells; they must be finite. `file` is for messages.
  CellSurface(const std::filesystem::path& file, const std::vector<Vec3>& points) : file_(file), points_(points) {}

  /// A triangle or a quadrangle that belongs to no volume. It counts only if there are no volume cells.
  void add_face(const std::int64_t* corners, int count);
  /// In VTK's order of corners: 4 a tetrahedron, 5 a pyramid, 6 a wedge, 8 a hexahedron. A tetrahedron may be given in
  /// any order. Throws InputError: a corner that does not exist, too many cells.
  void add_volume(const std::int64_t* corners, int count);

  /// Faces look outwards. Throws InputError: no faces, or one between three cells.
  TriMesh surface();

 private:
  /// Its smallest corner, the two beside it (the lesser first), and that opposite, or -1 for a triangle.
  struct Face {
    std::array<int, 4> key;
    bool turned;  ///< the greater neighbour follows the smallest corner
  };
  static Face face(std::array<int, 4> corners);
  int corner(std::int64_t i) const;

  std::filesystem::path file_;
  const std::vector<Vec3>& points_;
  std::vector<Face> of_volumes_, alone_;
  std::size_t cells_ = 0;
};

}  // namespace insula::case_builder
