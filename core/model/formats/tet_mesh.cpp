// SPDX-License-Identifier: GPL-3.0-or-later
// Reads a tetrahedral mesh: selects the reader by file name, then makes the checks of all formats.
#include <algorithm>
#include <cmath>

#include "core/model/formats/file_bytes.h"
#include "core/model/formats/raw_tets.h"

namespace insula {
namespace {

// Six times the volume over the cube of the longest edge: 0.7 for a regular tetrahedron. Below this it counts as flat.
constexpr double flat_limit = 1e-9;

std::string and_more(std::size_t others) { return others ? " (and " + std::to_string(others) + " more)" : ""; }

void check_nodes(const std::filesystem::path& file, const RawTets& raw, const std::vector<Vec3>& nodes) {
  std::size_t bad = 0, first = 0;
  for (std::size_t i = nodes.size(); i-- > 0;)
    if (!nodes[i].allFinite()) ++bad, first = i;
  if (bad) fail(file, "node " + std::to_string(raw.node_number[first]) + and_more(bad - 1) + " is not finite");
}

void check_indices(const std::filesystem::path& file, const RawTets& raw) {
  const auto n = std::int64_t(raw.nodes.size());
  for (std::size_t t = 0; t < raw.tets.size(); ++t)
    for (std::int64_t i : raw.tets[t])
      if (i < 0 || i >= n)
        fail(file, "tetrahedron " + std::to_string(raw.tet_number[t]) +
                       " names a node that does not exist (there are " + std::to_string(n) + " nodes)");
}

void check_shape(const std::filesystem::path& file, const RawTets& raw, const TetMesh& mesh) {
  std::size_t flat = 0, inverted = 0, first_flat = 0, first_inverted = 0;
  for (std::size_t t = mesh.tets.size(); t-- > 0;) {
    const auto& k = mesh.tets[t];
    double longest2 = 0;
    for (int i = 0; i < 4; ++i)
      for (int j = 0; j < i; ++j) longest2 = std::max(longest2, (mesh.nodes[k[i]] - mesh.nodes[k[j]]).squaredNorm());
    const Vec3& a = mesh.nodes[k[0]];
    const double volume6 = (mesh.nodes[k[1]] - a).cross(mesh.nodes[k[2]] - a).dot(mesh.nodes[k[3]] - a);
    const double limit = flat_limit * longest2 * std::sqrt(longest2);
    if (volume6 < -limit) {
      ++inverted, first_inverted = t;
    } else if (!(volume6 > limit)) {  // also finds coordinates so large that the volume is not finite
      ++flat, first_flat = t;
    }
  }
  if (inverted)
    fail(file,
         "tetrahedron " + std::to_string(raw.tet_number[first_inverted]) + and_more(inverted - 1) +
             " is inverted: its fourth node must lie on the side to which the first three turn counter-clockwise");
  if (flat) fail(file, "tetrahedron " + std::to_string(raw.tet_number[first_flat]) + and_more(flat - 1) + " is flat");
}

using TetReader = RawTets (*)(const std::filesystem::path&, std::string_view);

TetReader reader_for(const std::filesystem::path& file) {
  const std::string kind = lower_extension(file);
  if (kind == ".msh") return read_gmsh;
  if (kind == ".vtk") return read_vtk_legacy;
  if (kind == ".vtu") return read_vtu;
  if (kind == ".mesh") return read_medit;
  fail(file, "is no known tetrahedral mesh (use .msh, .vtk, .vtu or .mesh)");
}

}  // namespace

void check_unit(const std::filesystem::path& file, double metres_per_unit) {
  if (!(metres_per_unit > 0) || !std::isfinite(metres_per_unit))
    fail(file, "its unit of length must be positive and finite");
}

TetMesh checked_mesh(const std::filesystem::path& file, const RawTets& raw, double metres_per_unit) {
  check_unit(file, metres_per_unit);
  if (raw.tets.empty()) fail(file, "holds no tetrahedra");
  if (raw.nodes.size() > 100'000'000 || raw.tets.size() > 500'000'000) fail(file, "is too large");
  check_indices(file, raw);

  std::vector<Vec3> nodes(raw.nodes.size());
  for (std::size_t i = 0; i < nodes.size(); ++i) nodes[i] = raw.nodes[i] * metres_per_unit;
  check_nodes(file, raw, nodes);

  std::vector<int> place(nodes.size(), -1);
  for (const auto& tet : raw.tets)
    for (std::int64_t i : tet) place[std::size_t(i)] = 0;
  TetMesh mesh;
  for (std::size_t i = 0; i < nodes.size(); ++i)
    if (place[i] == 0) {
      place[i] = int(mesh.nodes.size());
      mesh.nodes.push_back(nodes[i]);
    }
  mesh.tets.reserve(raw.tets.size());
  for (const auto& tet : raw.tets) {
    std::array<int, 4> t;
    for (int i = 0; i < 4; ++i) t[i] = place[std::size_t(tet[i])];
    mesh.tets.push_back(t);
  }
  check_shape(file, raw, mesh);
  return mesh;
}

TetMesh tet_mesh_from_bytes(const std::filesystem::path& file, std::string_view bytes, double metres_per_unit) {
  return checked_mesh(file, reader_for(file)(file, bytes), metres_per_unit);
}

TetMesh read_tet_mesh(const std::filesystem::path& file, double metres_per_unit) {
  check_unit(file, metres_per_unit);
  reader_for(file);  // an unknown kind of file is reported before a missing file
  return tet_mesh_from_bytes(file, read_file_bytes(file), metres_per_unit);
}

}  // namespace insula
