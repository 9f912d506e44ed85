// SPDX-License-Identifier: GPL-3.0-or-later
// One small tetrahedral mesh and one surface for tests, in every format and encoding that is read.
#pragma once
#include <filesystem>
#include <functional>
#include <string>
#include <vector>

#include "core/model/mesh.h"
#include "core/testing/temp_folder.h"

namespace insula::test_files {

struct Format {
  std::string name;  ///< "gmsh41_binary"
  std::string file;  ///< file name with the right extension
  std::function<std::string(const TetMesh&)> bytes;
  bool number_from_one = false;  ///< how it counts tetrahedra
};

/// A box of 2 x 2 x 2 cubes of six tetrahedra each. Its inner node is moved, and its coordinates are no round numbers.
TetMesh box_mesh();
std::vector<Format> formats();

/// A closed tetrahedron-shaped surface with one quad's worth of shared vertices: four vertices, four triangles.
TriMesh small_surface();
struct SurfaceFormat {
  std::string name, file;
  std::function<std::string(const TriMesh&)> bytes;
  bool truncation_shows = true;  ///< false for OBJ, whose text may end anywhere
};
std::vector<SurfaceFormat> surface_formats();

}  // namespace insula::test_files
