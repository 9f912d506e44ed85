// SPDX-License-Identifier: GPL-3.0-or-later
// Common part of .vtk and .vtu: cells as connectivity, offsets and types, and their conversion to tetrahedra.
#include "core/model/formats/vtk_cells.h"

namespace insula {

std::size_t size_of(VtkType type) {
  switch (type) {
    case VtkType::i8:
    case VtkType::u8: return 1;
    case VtkType::i16:
    case VtkType::u16: return 2;
    case VtkType::i32:
    case VtkType::u32:
    case VtkType::f32: return 4;
    default: return 8;
  }
}

double read_value(ByteCursor& in, VtkType type, bool swap, const char* what) {
  switch (type) {
    case VtkType::i8: return in.binary<std::int8_t>(swap, what);
    case VtkType::u8: return in.binary<std::uint8_t>(swap, what);
    case VtkType::i16: return in.binary<std::int16_t>(swap, what);
    case VtkType::u16: return in.binary<std::uint16_t>(swap, what);
    case VtkType::i32: return in.binary<std::int32_t>(swap, what);
    case VtkType::u32: return in.binary<std::uint32_t>(swap, what);
    case VtkType::i64: return double(in.binary<std::int64_t>(swap, what));
    case VtkType::u64: return double(in.binary<std::uint64_t>(swap, what));
    case VtkType::f32: return double(in.binary<float>(swap, what));
    case VtkType::f64: return in.binary<double>(swap, what);
  }
  return 0;
}

void add_vtk_cells(const std::filesystem::path& file, const std::vector<std::int64_t>& connectivity,
                   const std::vector<std::int64_t>& ends, const std::vector<std::int64_t>& types, std::int64_t nodes,
                   std::int64_t first_node, std::int64_t first_cell, RawTets& raw) {
  constexpr std::int64_t vtk_tetra = 10;
  if (ends.size() != types.size())
    fail(file, "has " + std::to_string(ends.size()) + " cells and " + std::to_string(types.size()) + " cell types");
  std::int64_t begin = 0;
  for (std::size_t c = 0; c < ends.size(); ++c) {
    const std::int64_t number = first_cell + std::int64_t(c);
    if (ends[c] < begin || std::uint64_t(ends[c]) > connectivity.size())
      fail(file, "cell " + std::to_string(number) + " has a malformed list of nodes");
    // Types of a fixed size: vertex, line, triangle, pixel, quad, tetrahedron. A cut-off "10" reads as "1".
    const std::int64_t size = types[c] == 1                     ? 1
                              : types[c] == 3                   ? 2
                              : types[c] == 5                   ? 3
                              : types[c] >= 8 && types[c] <= 10 ? 4
                                                                : 0;
    if (types[c] < 0 || (size > 0 && ends[c] - begin != size))
      fail(file, "cell " + std::to_string(number) + " of VTK type " + std::to_string(types[c]) + " cannot have " +
                     std::to_string(ends[c] - begin) + " nodes");
    if (types[c] == vtk_tetra) {
      std::array<std::int64_t, 4> tet;
      for (int k = 0; k < 4; ++k) {
        const std::int64_t i = connectivity[std::size_t(begin + k)];
        tet[k] = i >= 0 && i < nodes ? first_node + i : -1;
      }
      raw.tets.push_back(tet);
      raw.tet_number.push_back(number);
    } else if (types[c] > 10 && types[c] != 21 && types[c] != 22 && types[c] != 23 && types[c] != 28) {
      // 21..23 and 28 are curves and faces of second order; all other types above 10 are volumes and would leave holes.
      fail(file, "cell " + std::to_string(number) + " has VTK type " + std::to_string(types[c]) +
                     "; only linear tetrahedra (type 10) can fill a volume here");
    }
    begin = ends[c];
  }
}

}  // namespace insula
