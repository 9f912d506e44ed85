// SPDX-License-Identifier: GPL-3.0-or-later
// VTK XML unstructured grids, .vtu, of one or more pieces.
#include "core/model/formats/vtk_xml.h"

namespace insula {

RawTets read_vtu(const std::filesystem::path& file, std::string_view bytes) {
  static const VtkXmlWanted wanted{"UnstructuredGrid",
                                   {{"Cells", "NumberOfCells", true, {"connectivity", "offsets", "types"}}}};
  const VtkXmlFile in(file, bytes, wanted);
  RawTets raw;
  std::int64_t cells = 0;
  for (const VtkXmlFile::Piece& piece : in.pieces()) {
    const VtkXmlFile::Section& s = piece.sections.at("Cells");
    const std::vector<double> x = in.positions(piece);
    const auto offsets = in.whole(s, "offsets", s.count);
    const auto types = in.whole(s, "types", s.count);
    const auto connectivity = in.whole(s, "connectivity", offsets.empty() ? 0 : offsets.back());
    const auto first = std::int64_t(raw.nodes.size());
    for (std::size_t i = 0; i < std::size_t(piece.points); ++i) {
      raw.nodes.emplace_back(x[3 * i], x[3 * i + 1], x[3 * i + 2]);
      raw.node_number.push_back(first + std::int64_t(i));
    }
    add_vtk_cells(file, connectivity, offsets, types, piece.points, first, cells, raw);
    cells += s.count;
  }
  return raw;
}

}  // namespace insula
