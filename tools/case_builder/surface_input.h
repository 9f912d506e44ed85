// SPDX-License-Identifier: GPL-3.0-or-later
// Surface files of any kind that an author may have, of a vessel or of a brain.
#pragma once
#include <filesystem>
#include <optional>

#include "core/model/mesh.h"

namespace insula::case_builder {

/// Whether the file's format says that it is in metres (glTF 2.0, section 3.4).
bool is_in_metres(const std::filesystem::path& file);
/// Millimetres a unit of the file: what was given, else what the format says, else 1.
double unit_mm(const std::filesystem::path& file, const std::optional<double>& given);
/// Every format of read_surface, VTP, VTU and HDF5; mm. Throws InputError.
TriMesh read_any_surface(const std::filesystem::path& file, double unit_mm);
/// Diagonal of the box around all vertices; 0 without any.
double extent_of(const TriMesh& mesh);

}  // namespace insula::case_builder
