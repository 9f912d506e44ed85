// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/case_builder/vtu_surface.h"

#include "core/model/formats/vtk_xml.h"
#include "tools/case_builder/cell_surface.h"

namespace insula::case_builder {
namespace {

/// Of a cell of that VTK type ("VTK File Formats", figures 2 and 3): nodes, corners, and whether it is a volume.
struct CellKind {
  int nodes = 0, corners = 0;
  bool volume = false;
};
CellKind kind_of(std::int64_t type) {
  switch (type) {
    case 5: return {3, 3, false};
    case 9: return {4, 4, false};
    case 10: return {4, 4, true};
    case 12: return {8, 8, true};
    case 13: return {6, 6, true};
    case 14: return {5, 5, true};
    case 22: return {6, 3, false};
    case 23: return {8, 4, false};
    case 24: return {10, 4, true};
    case 25: return {20, 8, true};
    case 26: return {15, 6, true};
    default: return {};
  }
}

void add_cells(const std::filesystem::path& file, const VtkXmlFile& in, const VtkXmlFile::Piece& piece,
               std::int64_t first, CellSurface& out) {
  const VtkXmlFile::Section& cells = piece.sections.at("Cells");
  if (cells.count == 0) return;
  const auto offsets = in.whole(cells, "offsets", cells.count);
  const auto types = in.whole(cells, "types", cells.count);
  auto nodes = in.whole(cells, "connectivity", offsets.back());
  for (std::int64_t& i : nodes) i = i >= 0 && i < piece.points ? first + i : -1;
  std::int64_t begin = 0;
  for (std::size_t c = 0; c < offsets.size(); begin = offsets[c++]) {
    const CellKind kind = kind_of(types[c]);
    if (types[c] >= 0 && types[c] <= 4) continue;  // points and lines
    const std::string which = "cell " + std::to_string(c) + " of VTK type " + std::to_string(types[c]);
    if (kind.nodes == 0) fail(file, which + " is not read; write the surface as .vtp or .stl");
    if (offsets[c] - begin != kind.nodes || begin < 0 || std::uint64_t(offsets[c]) > nodes.size())
      fail(file, which + " has a malformed list of points");
    const std::int64_t* corners = nodes.data() + begin;
    if (kind.volume) out.add_volume(corners, kind.corners);
    else out.add_face(corners, kind.corners);
  }
}

}  // namespace

TriMesh read_vtu_surface(const std::filesystem::path& file) {
  static const VtkXmlWanted wanted{"UnstructuredGrid",
                                   {{"Cells", "NumberOfCells", true, {"connectivity", "offsets", "types"}}}};
  const std::string bytes = read_file_bytes(file);
  const VtkXmlFile in(file, bytes, wanted);
  std::vector<Vec3> points;
  std::vector<std::int64_t> first;
  for (const VtkXmlFile::Piece& piece : in.pieces()) {
    first.push_back(std::int64_t(points.size()));
    if (piece.points == 0) continue;
    const std::vector<double> x = in.positions(piece);
    for (std::size_t i = 0; i + 2 < x.size(); i += 3) {
      points.emplace_back(x[i], x[i + 1], x[i + 2]);
      if (!points.back().allFinite()) fail(file, "point " + std::to_string(i / 3) + " is not finite");
    }
  }
  CellSurface out(file, points);
  for (std::size_t p = 0; p < in.pieces().size(); ++p) add_cells(file, in, in.pieces()[p], first[p], out);
  return out.surface();
}

}  // namespace insula::case_builder
