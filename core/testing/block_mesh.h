// SPDX-License-Identifier: GPL-3.0-or-later
// Structured tetrahedral boxes for tests: refinement studies and small scenes without shipped meshes.
#pragma once
#include <array>
#include <filesystem>
#include <string>

#include "core/model/mesh.h"

namespace insula::test {

/// A box from `low` to `high` (m) of cells[0] x cells[1] x cells[2] cubes, six tetrahedra each around the cube's
/// diagonal. Node (i, j, k) has number (i (cells[1] + 1) + j) (cells[2] + 1) + k.
TetMesh block_mesh(const std::array<int, 3>& cells, const Vec3& low, const Vec3& high);

/// One tetrahedron with its fourth node above the first three: (0 0 0), (a 0 0), (0 a 0), (0 0 a); shifted by `at`.
TetMesh single_tet(double a, const Vec3& at = Vec3::Zero());

/// gmsh 2.2 ASCII, all digits, in metres.
std::string gmsh_text(const TetMesh& mesh);

/// OBJ text of a surface in metres.
std::string obj_text(const TriMesh& mesh);

/// A temporary folder with a `meshes` folder in it. Scenes written there may name its meshes.
class SceneFolder {
 public:
  SceneFolder();
  ~SceneFolder();
  SceneFolder(const SceneFolder&) = delete;
  SceneFolder& operator=(const SceneFolder&) = delete;
  std::filesystem::path path() const { return path_; }
  /// Writes a file below the folder, e.g. "meshes/bar.msh".
  void write(const std::string& name, const std::string& text) const;

 private:
  std::filesystem::path path_;
};

/// URDF text and tool.json of a tool for tests. The URDF has a ball of `radius` (m) at the tip and the inertia of a
/// rod. `edge` > 0 gives the tool a cutting edge along its y axis, of that half-length (m). `inner_radius` > 0 gives it
/// an opening for suction (m).
std::string test_tool_urdf(double radius);
std::string test_tool_json(double edge, double inner_radius);

}  // namespace insula::test
