// SPDX-License-Identifier: GPL-3.0-or-later
// The output of every reader of tetrahedral meshes, and the one function that checks it.
#pragma once
#include <array>
#include <cstdint>
#include <filesystem>
#include <string_view>
#include <vector>

#include "core/model/mesh.h"

namespace insula {

/// The data as in the file, in the file's unit, unchecked.
struct RawTets {
  std::vector<Vec3> nodes;
  std::vector<std::int64_t> node_number;          ///< as the file counts or names them, for messages
  std::vector<std::array<std::int64_t, 4>> tets;  ///< indices into `nodes`; any value may occur
  std::vector<std::int64_t> tet_number;           ///< as the file counts or names them, for messages
};

RawTets read_gmsh(const std::filesystem::path& file, std::string_view bytes);
RawTets read_vtk_legacy(const std::filesystem::path& file, std::string_view bytes);
RawTets read_vtu(const std::filesystem::path& file, std::string_view bytes);
RawTets read_medit(const std::filesystem::path& file, std::string_view bytes);

/// Checks and scales. Throws InputError that names the first error of each kind.
TetMesh checked_mesh(const std::filesystem::path& file, const RawTets& raw, double metres_per_unit);

/// The part of read_tet_mesh that works on the bytes of `file` (its extension names the format).
TetMesh tet_mesh_from_bytes(const std::filesystem::path& file, std::string_view bytes, double metres_per_unit);

/// Throws InputError unless `metres_per_unit` is positive and finite.
void check_unit(const std::filesystem::path& file, double metres_per_unit);

}  // namespace insula
