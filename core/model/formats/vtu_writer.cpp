// SPDX-License-Identifier: GPL-3.0-or-later
// Writes .vtu with appended raw data in the machine's byte order: every double keeps all its bits.
#include <cstdint>
#include <fstream>
#include <string>

#include "core/model/formats/file_bytes.h"
#include "core/model/mesh.h"

namespace insula {
namespace {

class Appended {
 public:
  template <class T>
  std::size_t add(const std::vector<T>& values) {
    const std::size_t at = bytes_.size();
    const std::uint64_t n = values.size() * sizeof(T);
    bytes_.append(reinterpret_cast<const char*>(&n), sizeof n);
    bytes_.append(reinterpret_cast<const char*>(values.data()), std::size_t(n));
    return at;
  }
  const std::string& bytes() const { return bytes_; }

 private:
  std::string bytes_;
};

std::vector<double> flat(const std::vector<Vec3>& v) {
  std::vector<double> out;
  out.reserve(3 * v.size());
  for (const Vec3& p : v) out.insert(out.end(), p.data(), p.data() + 3);
  return out;
}

std::string array(const char* type, const char* name, int components, std::size_t offset) {
  return std::string("        <DataArray type=\"") + type + "\" Name=\"" + name + "\" NumberOfComponents=\"" +
         std::to_string(components) + "\" format=\"appended\" offset=\"" + std::to_string(offset) + "\"/>\n";
}

template <std::size_t corners>
void write(const std::filesystem::path& file, const std::vector<Vec3>& nodes,
           const std::vector<std::array<int, corners>>& cells, const std::vector<Vec3>& displacement) {
  constexpr std::uint8_t vtk_type = corners == 4 ? 10 : 5;  // VTK_TETRA, VTK_TRIANGLE
  if (!displacement.empty() && displacement.size() != nodes.size())
    fail(file, "cannot be written: one displacement a node is needed");
  Appended data;
  std::vector<std::int64_t> connectivity, ends;
  for (const auto& t : cells) {
    connectivity.insert(connectivity.end(), t.begin(), t.end());
    ends.push_back(std::int64_t(connectivity.size()));
  }
  std::string xml = "<?xml version=\"1.0\"?>\n<VTKFile type=\"UnstructuredGrid\" version=\"1.0\" byte_order=\"";
  xml += machine_is_little_endian ? "LittleEndian" : "BigEndian";
  xml += "\" header_type=\"UInt64\">\n  <UnstructuredGrid>\n    <Piece NumberOfPoints=\"" +
         std::to_string(nodes.size()) + "\" NumberOfCells=\"" + std::to_string(cells.size()) + "\">\n";
  if (!displacement.empty())
    xml += "      <PointData Vectors=\"displacement\">\n" +
           array("Float64", "displacement", 3, data.add(flat(displacement))) + "      </PointData>\n";
  xml += "      <Points>\n" + array("Float64", "Points", 3, data.add(flat(nodes))) + "      </Points>\n      <Cells>\n";
  xml += array("Int64", "connectivity", 1, data.add(connectivity));
  xml += array("Int64", "offsets", 1, data.add(ends));
  xml += array("UInt8", "types", 1, data.add(std::vector<std::uint8_t>(cells.size(), vtk_type)));
  xml += "      </Cells>\n    </Piece>\n  </UnstructuredGrid>\n  <AppendedData encoding=\"raw\">\n_";
  std::ofstream out(file, std::ios::binary | std::ios::trunc);
  out << xml << data.bytes() << "\n  </AppendedData>\n</VTKFile>\n";
  out.close();
  if (!out) fail(file, "cannot be written");
}

}  // namespace

void write_vtu(const std::filesystem::path& file, const std::vector<Vec3>& nodes,
               const std::vector<std::array<int, 4>>& tets, const std::vector<Vec3>& displacement) {
  write(file, nodes, tets, displacement);
}

void write_vtu(const std::filesystem::path& file, const std::vector<Vec3>& nodes,
               const std::vector<std::array<int, 3>>& triangles, const std::vector<Vec3>& displacement) {
  write(file, nodes, triangles, displacement);
}

}  // namespace insula
