// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/case_builder/vtp_reader.h"

#include "core/model/formats/vtk_xml.h"

namespace insula::case_builder {
namespace {

void add_cells(const std::filesystem::path& file, const VtkXmlFile& in, const VtkXmlFile::Section& cells, bool strip,
               std::int64_t points, int first, TriMesh& mesh) {
  if (cells.count == 0) return;
  const auto offsets = in.whole(cells, "offsets", cells.count);
  const auto nodes = in.whole(cells, "connectivity", offsets.back());
  std::int64_t begin = 0;
  for (const std::int64_t end : offsets) {
    if (end < begin || std::uint64_t(end) > nodes.size()) fail(file, "a polygon has a malformed list of points");
    const auto at = [&](std::int64_t k) {
      const std::int64_t i = nodes[std::size_t(k)];
      if (i < 0 || i >= points)
        fail(file, "a polygon names point " + std::to_string(i) + " of " + std::to_string(points));
      return first + int(i);
    };
    for (std::int64_t k = begin + 2; k < end; ++k) {
      const bool odd = strip && (k - begin) % 2 == 1;
      const int a = strip ? at(k - 2) : at(begin), b = at(k - 1), c = at(k);
      if (odd) mesh.triangles.push_back({b, a, c});
      else mesh.triangles.push_back({a, b, c});
    }
    begin = end;
  }
}

}  // namespace

TriMesh read_vtp(const std::filesystem::path& file) {
  static const VtkXmlWanted wanted{"PolyData",
                                   {{"Polys", "NumberOfPolys", false, {"connectivity", "offsets"}},
                                    {"Strips", "NumberOfStrips", false, {"connectivity", "offsets"}}}};
  const std::string bytes = read_file_bytes(file);
  const VtkXmlFile in(file, bytes, wanted);
  TriMesh mesh;
  for (const VtkXmlFile::Piece& piece : in.pieces()) {
    if (piece.points == 0) continue;
    const std::vector<double> x = in.positions(piece);
    const int first = int(mesh.vertices.size());
    for (std::size_t i = 0; i + 2 < x.size(); i += 3) {
      mesh.vertices.emplace_back(x[i], x[i + 1], x[i + 2]);
      if (!mesh.vertices.back().allFinite()) fail(file, "point " + std::to_string(i / 3) + " is not finite");
    }
    add_cells(file, in, piece.sections.at("Polys"), false, piece.points, first, mesh);
    add_cells(file, in, piece.sections.at("Strips"), true, piece.points, first, mesh);
  }
  if (mesh.triangles.empty()) fail(file, "holds no triangles");
  return mesh;
}

}  // namespace insula::case_builder
