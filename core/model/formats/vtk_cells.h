// SPDX-License-Identifier: GPL-3.0-or-later
// The common part of .vtk and .vtu: cells as connectivity, offsets and types, and their conversion to tetrahedra.
#pragma once
#include <string_view>

#include "core/model/formats/file_bytes.h"
#include "core/model/formats/raw_tets.h"

namespace insula {

/// Number types by their name in .vtu files.
enum class VtkType { i8, u8, i16, u16, i32, u32, i64, u64, f32, f64 };
std::size_t size_of(VtkType type);

/// A binary value of that type as a number (integers beyond 2^53 lose digits).
double read_value(ByteCursor& in, VtkType type, bool swap, const char* what);

/// Appends the tetrahedra. `ends[c]` is one past cell c's last entry of `connectivity`. `first_node` is added to node
/// indices that are in the range of `nodes` (those of this piece). Throws InputError: malformed, other volume cells.
void add_vtk_cells(const std::filesystem::path& file, const std::vector<std::int64_t>& connectivity,
                   const std::vector<std::int64_t>& ends, const std::vector<std::int64_t>& types, std::int64_t nodes,
                   std::int64_t first_node, std::int64_t first_cell, RawTets& raw);

}  // namespace insula
