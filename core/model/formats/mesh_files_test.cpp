// SPDX-License-Identifier: GPL-3.0-or-later
// Shared by the tests beside it: one mesh and one surface written in every format. Written from the formats' manuals,
// not with the readers, so that a shared misunderstanding cannot hide.
#include "core/model/formats/mesh_files_for_test.h"

#include <zlib.h>

#include <algorithm>
#include <bit>
#include <cstdint>
#include <cstdio>
#include <cstring>
#include <fstream>
#include <random>

namespace insula::test_files {
namespace {

static_assert(std::endian::native == std::endian::little, "the writers below assume it");

template <class T>
void put(std::string& out, T value, bool big_endian = false) {
  char raw[sizeof(T)];
  std::memcpy(raw, &value, sizeof(T));
  if (big_endian) std::reverse(raw, raw + sizeof(T));
  out.append(raw, sizeof(T));
}

std::string num(double v) {
  char buffer[40];
  std::snprintf(buffer, sizeof buffer, "%.17g", v);
  return buffer;
}
std::string num(std::int64_t v) { return std::to_string(v); }
std::string line(const Vec3& p) { return num(p.x()) + " " + num(p.y()) + " " + num(p.z()); }

// gmsh: node tags are 10, 12, 14, ...; one triangle and one node that no tetrahedron uses stand in between.
std::int64_t tag(std::size_t node) { return 10 + 2 * std::int64_t(node); }

std::string gmsh22(const TetMesh& m, bool binary) {
  std::string s = std::string("$MeshFormat\n2.2 ") + (binary ? "1" : "0") + " 8\n";
  if (binary) put<std::int32_t>(s, 1), s += "\n";
  s += "$EndMeshFormat\n$PhysicalNames\n1\n3 1 \"tissue\"\n$EndPhysicalNames\n$Nodes\n" +
       num(std::int64_t(m.nodes.size() + 1)) + "\n";
  const auto node = [&](std::int64_t t, const Vec3& p) {
    if (!binary) return void(s += num(t) + " " + line(p) + "\n");
    put<std::int32_t>(s, std::int32_t(t));
    for (int k = 0; k < 3; ++k) put<double>(s, p[k]);
  };
  node(5, Vec3(100, 100, 100));  // used by nothing
  for (std::size_t i = 0; i < m.nodes.size(); ++i) node(tag(i), m.nodes[i]);
  s += binary ? "\n$EndNodes\n$Elements\n" : "$EndNodes\n$Elements\n";
  s += num(std::int64_t(m.tets.size() + 1)) + "\n";
  if (binary) {
    for (std::int32_t v : {2, 1, 2, 1, 7, 7, int(tag(0)), int(tag(1)), int(tag(2))}) put<std::int32_t>(s, v);
    for (std::int32_t v : {4, int(m.tets.size()), 2}) put<std::int32_t>(s, v);
  } else {
    s += "1 2 2 7 7 " + num(tag(0)) + " " + num(tag(1)) + " " + num(tag(2)) + "\n";
  }
  for (std::size_t t = 0; t < m.tets.size(); ++t) {
    if (binary)
      for (std::int32_t v : {int(t) + 2, 7, 7}) put<std::int32_t>(s, v);
    else s += num(std::int64_t(t) + 2) + " 4 2 7 7";
    for (int i : m.tets[t])
      if (binary) put<std::int32_t>(s, std::int32_t(tag(std::size_t(i))));
      else s += " " + num(tag(std::size_t(i)));
    if (!binary) s += "\n";
  }
  return s + (binary ? "\n$EndElements\n" : "$EndElements\n");
}

std::string gmsh41(const TetMesh& m, bool binary, bool big = false) {
  std::string s = std::string("$MeshFormat\n4.1 ") + (binary ? "1" : "0") + " 8\n";
  if (binary) put<std::int32_t>(s, 1, big), s += "\n";
  s += "$EndMeshFormat\n";
  const auto i32 = [&](std::int64_t v) {
    binary ? put<std::int32_t>(s, std::int32_t(v), big) : void(s += num(v) + " ");
  };
  const auto u64 = [&](std::int64_t v) {
    binary ? put<std::uint64_t>(s, std::uint64_t(v), big) : void(s += num(v) + " ");
  };
  const auto real = [&](double v) { binary ? put<double>(s, v, big) : void(s += num(v) + " "); };
  const auto end_line = [&] {
    if (!binary) s += "\n";
  };
  s += "$Entities\n";
  for (int i = 0; i < 4; ++i) u64(0);
  end_line();
  if (binary) s += "\n";
  s += "$EndEntities\n$Nodes\n";
  const std::int64_t n = std::int64_t(m.nodes.size());
  u64(2), u64(n + 1), u64(5), u64(tag(m.nodes.size()));
  end_line();
  i32(2), i32(1), i32(1), u64(1);  // a parametric block on a face: u and v follow the coordinates
  end_line();
  u64(5);
  end_line();
  for (int k = 0; k < 3; ++k) real(100);
  real(0.25), real(0.75);
  end_line();
  i32(3), i32(1), i32(0), u64(n);
  end_line();
  for (std::size_t i = 0; i < m.nodes.size(); ++i) u64(tag(i)), end_line();
  for (const Vec3& p : m.nodes) {
    for (int k = 0; k < 3; ++k) real(p[k]);
    end_line();
  }
  if (binary) s += "\n";
  s += "$EndNodes\n$Elements\n";
  const std::int64_t e = std::int64_t(m.tets.size());
  u64(2), u64(e + 1), u64(1), u64(e + 1);
  end_line();
  i32(2), i32(1), i32(2), u64(1);
  end_line();
  u64(1);
  for (std::size_t i = 0; i < 3; ++i) u64(tag(i));
  end_line();
  i32(3), i32(1), i32(4), u64(e);
  end_line();
  for (std::size_t t = 0; t < m.tets.size(); ++t) {
    u64(std::int64_t(t) + 2);
    for (int i : m.tets[t]) u64(tag(std::size_t(i)));
    end_line();
  }
  if (binary) s += "\n";
  return s + "$EndElements\n";
}

std::string vtk(const TetMesh& m, bool binary, bool version5) {
  std::string s = std::string("# vtk DataFile Version ") + (version5 ? "5.1" : "3.0") + "\na box\n" +
                  (binary ? "BINARY" : "ASCII") + "\nDATASET UNSTRUCTURED_GRID\n";
  const auto real = [&](double v) { binary ? put<double>(s, v, true) : void(s += num(v) + " "); };
  const auto i32 = [&](std::int64_t v) {
    binary ? put<std::int32_t>(s, std::int32_t(v), true) : void(s += num(v) + " ");
  };
  const auto i64 = [&](std::int64_t v) { binary ? put<std::int64_t>(s, v, true) : void(s += num(v) + " "); };
  s += "FIELD FieldData 1\nTIME 1 1 double\n";
  real(2.5);
  s += "\nPOINTS " + num(std::int64_t(m.nodes.size())) + " double\n";
  for (const Vec3& p : m.nodes)
    for (int k = 0; k < 3; ++k) real(p[k]);
  const std::int64_t n = std::int64_t(m.tets.size());
  if (version5) {
    s += "\nMETADATA\nINFORMATION 0\n\nCELLS " + num(n + 1) + " " + num(4 * n) + "\nOFFSETS vtktypeint64\n";
    for (std::int64_t i = 0; i <= n; ++i) i64(4 * i);
    s += "\nCONNECTIVITY vtktypeint64\n";
    for (const auto& t : m.tets)
      for (int i : t) i64(i);
  } else {
    s += "\nCELLS " + num(n) + " " + num(5 * n) + "\n";
    for (const auto& t : m.tets) {
      i32(4);
      for (int i : t) i32(i);
    }
  }
  s += "\nCELL_TYPES " + num(n) + "\n";
  for (std::int64_t i = 0; i < n; ++i) i32(10);
  return s + "\n";
}

std::string base64(const std::string& in) {
  static const char* digits = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::string out;
  for (std::size_t i = 0; i < in.size(); i += 3) {
    unsigned bits = 0;
    for (std::size_t k = 0; k < 3; ++k)
      bits = bits << 8 | (i + k < in.size() ? static_cast<unsigned char>(in[i + k]) : 0u);
    for (std::size_t k = 0; k < 4; ++k) out += i + k <= in.size() ? digits[bits >> (18 - 6 * k) & 63] : '=';
  }
  return out;
}

enum class Coding { ascii, inline_base64, inline_zlib, raw, raw_zlib, appended_base64 };

/// Writes the data arrays of a VTK XML file in one coding.
class VtuArrays {
 public:
  explicit VtuArrays(Coding coding) : coding_(coding) {}
  bool zlib() const { return coding_ == Coding::inline_zlib || coding_ == Coding::raw_zlib; }
  bool appended() const {
    return coding_ == Coding::raw || coding_ == Coding::raw_zlib || coding_ == Coding::appended_base64;
  }
  bool header64() const { return coding_ == Coding::raw || coding_ == Coding::inline_zlib; }

  /// Returns the array's element. With an appended coding, the content goes to the appended section.
  std::string array(const char* type, const std::string& name, int parts, const std::string& raw,
                    const std::string& text) {
    std::string s = std::string("<DataArray type=\"") + type + "\" Name=\"" + name + "\" NumberOfComponents=\"" +
                    std::to_string(parts) + "\" format=\"";
    if (coding_ == Coding::ascii) return s + "ascii\">\n" + text + "\n</DataArray>\n";
    if (!appended()) return s + "binary\">\n" + packed(raw) + "\n</DataArray>\n";
    s += "appended\" offset=\"" + std::to_string(store_.size()) + "\"/>\n";
    store_ += packed(raw);
    return s;
  }
  std::string appended_section() const {
    if (!appended()) return "";
    return std::string("<AppendedData encoding=\"") + (coding_ == Coding::appended_base64 ? "base64" : "raw") +
           "\">\n_" + store_ + "\n</AppendedData>\n";
  }

 private:
  void header(std::string& to, std::uint64_t v) const {
    header64() ? put<std::uint64_t>(to, v) : put<std::uint32_t>(to, std::uint32_t(v));
  }
  std::string packed(const std::string& raw) const {
    std::string head, body;
    if (zlib()) {  // blocks of 200 bytes
      const std::size_t block = 200, blocks = (raw.size() + block - 1) / block;
      header(head, blocks), header(head, block), header(head, raw.size() % block);
      for (std::size_t b = 0; b < blocks; ++b) {
        const std::string part = raw.substr(b * block, block);
        std::string z(compressBound(part.size()), '\0');
        uLongf n = z.size();
        compress(reinterpret_cast<Bytef*>(z.data()), &n, reinterpret_cast<const Bytef*>(part.data()), part.size());
        header(head, n);
        body += z.substr(0, n);
      }
      return coding_ == Coding::inline_zlib ? base64(head) + base64(body) : head + body;
    }
    header(head, raw.size());
    return coding_ == Coding::raw ? head + raw : base64(head + raw);
  }

  Coding coding_;
  std::string store_;  ///< content of the appended section
};

std::string vtu(const TetMesh& m, Coding coding) {
  VtuArrays arrays(coding);
  std::string s =
      std::string(
          "<?xml version=\"1.0\"?>\n<VTKFile type=\"UnstructuredGrid\" version=\"1.0\" byte_order=\"LittleEndian\"") +
      (arrays.header64() ? " header_type=\"UInt64\"" : "") +
      (arrays.zlib() ? " compressor=\"vtkZLibDataCompressor\"" : "") +
      ">\n<UnstructuredGrid>\n<Piece NumberOfPoints=\"" + std::to_string(m.nodes.size()) + "\" NumberOfCells=\"" +
      std::to_string(m.tets.size()) + "\">\n<PointData/><Points>\n";
  std::string x, xt, c, ct, o, ot, y, yt;
  for (const Vec3& p : m.nodes) {
    for (int k = 0; k < 3; ++k) put<double>(x, p[k]);
    xt += line(p) + "\n";
  }
  std::int64_t end = 0;
  for (const auto& t : m.tets) {
    for (int i : t) put<std::int32_t>(c, i), ct += std::to_string(i) + " ";
    put<std::int64_t>(o, end += 4), ot += std::to_string(end) + " ";
    put<std::uint8_t>(y, 10), yt += "10 ";
  }
  s += arrays.array("Float64", "Points", 3, x, xt) + "</Points>\n<Cells>\n";
  s += arrays.array("Int32", "connectivity", 1, c, ct);
  s += arrays.array("Int64", "offsets", 1, o, ot);
  s += arrays.array("UInt8", "types", 1, y, yt) + "</Cells>\n</Piece>\n</UnstructuredGrid>\n";
  return s + arrays.appended_section() + "</VTKFile>\n";
}

std::string medit(const TetMesh& m) {
  std::string s =
      "MeshVersionFormatted 2\n# a comment\nDimension\n3\nVertices\n" + std::to_string(m.nodes.size()) + "\n";
  for (const Vec3& p : m.nodes) s += line(p) + " 0\n";
  s += "Triangles\n1\n1 2 3 4\nTetrahedra\n" + std::to_string(m.tets.size()) + "\n";
  for (const auto& t : m.tets) {
    for (int i : t) s += std::to_string(i + 1) + " ";
    s += "1\n";
  }
  return s + "End\n";
}

std::string stl_binary(const TriMesh& m) {
  std::string s(80, ' ');
  put<std::uint32_t>(s, std::uint32_t(m.triangles.size()));
  for (const auto& t : m.triangles) {
    for (int k = 0; k < 3; ++k) put<float>(s, 0);
    for (int i : t)
      for (int k = 0; k < 3; ++k) put<float>(s, float(m.vertices[std::size_t(i)][k]));
    put<std::uint16_t>(s, 0);
  }
  return s;
}

std::string stl_ascii(const TriMesh& m) {
  std::string s = "solid small\n";
  for (const auto& t : m.triangles) {
    s += "facet normal 0 0 1\nouter loop\n";
    for (int i : t) s += "vertex " + line(m.vertices[std::size_t(i)]) + "\n";
    s += "endloop\nendfacet\n";
  }
  return s + "endsolid\n";
}

std::string obj(const TriMesh& m) {
  std::string s = "# small\no part\n";
  for (const Vec3& v : m.vertices) s += "v " + line(v) + "\n";
  for (const auto& t : m.triangles)
    s += "f " + std::to_string(t[0] + 1) + " " + std::to_string(t[1] + 1) + " " + std::to_string(t[2] + 1) + "\n";
  return s;
}

std::string off(const TriMesh& m) {
  std::string s = "OFF\n" + std::to_string(m.vertices.size()) + " " + std::to_string(m.triangles.size()) + " 0\n";
  for (const Vec3& v : m.vertices) s += line(v) + "\n";
  for (const auto& t : m.triangles)
    s += "3 " + std::to_string(t[0]) + " " + std::to_string(t[1]) + " " + std::to_string(t[2]) + "\n";
  return s;
}

std::string ply(const TriMesh& m, bool binary) {
  std::string s = std::string("ply\nformat ") + (binary ? "binary_little_endian" : "ascii") + " 1.0\nelement vertex " +
                  std::to_string(m.vertices.size()) +
                  "\nproperty float x\nproperty float y\nproperty float z\nelement face " +
                  std::to_string(m.triangles.size()) + "\nproperty list uchar int vertex_indices\nend_header\n";
  for (const Vec3& v : m.vertices) {
    if (binary)
      for (int k = 0; k < 3; ++k) put<float>(s, float(v[k]));
    else s += line(v) + "\n";
  }
  for (const auto& t : m.triangles) {
    if (binary) put<std::uint8_t>(s, 3);
    else s += "3 ";
    for (int i : t)
      if (binary) put<std::int32_t>(s, i);
      else s += std::to_string(i) + " ";
    if (!binary) s += "\n";
  }
  return s;
}

std::string gltf_parts(const TriMesh& m, std::string& buffer) {
  for (const Vec3& v : m.vertices)
    for (int k = 0; k < 3; ++k) put<float>(buffer, float(v[k]));
  const std::size_t split = buffer.size();
  for (const auto& t : m.triangles)
    for (int i : t) put<std::uint32_t>(buffer, std::uint32_t(i));
  Vec3 low = m.vertices[0], high = low;
  for (const Vec3& v : m.vertices) low = low.cwiseMin(v), high = high.cwiseMax(v);
  const auto list = [](const Vec3& v) { return "[" + num(v.x()) + "," + num(v.y()) + "," + num(v.z()) + "]"; };
  return "\"asset\":{\"version\":\"2.0\"},\"scene\":0,\"scenes\":[{\"nodes\":[0]}],\"nodes\":[{\"mesh\":0}],"
         "\"meshes\":[{\"primitives\":[{\"attributes\":{\"POSITION\":0},\"indices\":1}]}],"
         "\"accessors\":[{\"bufferView\":0,\"componentType\":5126,\"count\":" +
         std::to_string(m.vertices.size()) + ",\"type\":\"VEC3\",\"min\":" + list(low) + ",\"max\":" + list(high) +
         "},{\"bufferView\":1,\"componentType\":5125,\"count\":" + std::to_string(3 * m.triangles.size()) +
         ",\"type\":\"SCALAR\"}],\"bufferViews\":[{\"buffer\":0,\"byteOffset\":0,\"byteLength\":" +
         std::to_string(split) + "},{\"buffer\":0,\"byteOffset\":" + std::to_string(split) +
         ",\"byteLength\":" + std::to_string(buffer.size() - split) + "}]";
}

std::string gltf(const TriMesh& m) {
  std::string buffer;
  const std::string parts = gltf_parts(m, buffer);
  return "{" + parts + ",\"buffers\":[{\"byteLength\":" + std::to_string(buffer.size()) +
         ",\"uri\":\"data:application/octet-stream;base64," + base64(buffer) + "\"}]}";
}

std::string glb(const TriMesh& m) {
  std::string buffer;
  std::string json = gltf_parts(m, buffer);
  json = "{" + json + ",\"buffers\":[{\"byteLength\":" + std::to_string(buffer.size()) + "}]}";
  while (json.size() % 4) json += ' ';
  std::string s = "glTF";
  put<std::uint32_t>(s, 2), put<std::uint32_t>(s, std::uint32_t(12 + 8 + json.size() + 8 + buffer.size()));
  put<std::uint32_t>(s, std::uint32_t(json.size())), s += "JSON" + json;
  put<std::uint32_t>(s, std::uint32_t(buffer.size())), s += std::string("BIN\0", 4) + buffer;
  return s;
}

}  // namespace

TetMesh box_mesh() {
  TetMesh m;
  constexpr int n = 2;
  for (int z = 0; z <= n; ++z)
    for (int y = 0; y <= n; ++y)
      for (int x = 0; x <= n; ++x) m.nodes.emplace_back(1.1 * x + 0.13 * y, 0.9 * y - 1.0 / 3, 1.3 * z + 0.07 * x);
  m.nodes[13] += Vec3(0.11, -0.07, 0.05);
  static constexpr int path[6][2] = {{0, 1}, {0, 2}, {1, 0}, {1, 2}, {2, 0}, {2, 1}};  // six paths along the axes
  for (int cell = 0; cell < n * n * n; ++cell) {
    const int base[3] = {cell % n, cell / n % n, cell / (n * n)};
    for (const auto& w : path) {
      int at[3] = {base[0], base[1], base[2]};
      const auto number = [&] { return at[0] + (n + 1) * (at[1] + (n + 1) * at[2]); };
      std::array<int, 4> t;
      t[0] = number();
      ++at[w[0]], t[1] = number();
      ++at[w[1]], t[2] = number();
      ++at[3 - w[0] - w[1]], t[3] = number();
      const Vec3& a = m.nodes[std::size_t(t[0])];
      const auto edge = [&](int k) -> Vec3 { return m.nodes[std::size_t(t[std::size_t(k)])] - a; };
      if (edge(1).cross(edge(2)).dot(edge(3)) < 0) std::swap(t[1], t[2]);
      m.tets.push_back(t);
    }
  }
  return m;
}

std::vector<Format> formats() {
  const auto with = [](auto f, auto... options) { return [=](const TetMesh& m) { return f(m, options...); }; };
  return {{"gmsh22_ascii", "m.msh", with(gmsh22, false)},
          {"gmsh22_binary", "m.msh", with(gmsh22, true)},
          {"gmsh41_ascii", "m.msh", with(gmsh41, false, false)},
          {"gmsh41_binary", "m.msh", with(gmsh41, true, false)},
          {"gmsh41_big_endian", "m.msh", with(gmsh41, true, true)},
          {"vtk3_ascii", "m.vtk", with(vtk, false, false)},
          {"vtk3_binary", "m.vtk", with(vtk, true, false)},
          {"vtk5_ascii", "m.vtk", with(vtk, false, true)},
          {"vtk5_binary", "m.vtk", with(vtk, true, true)},
          {"vtu_ascii", "m.vtu", with(vtu, Coding::ascii)},
          {"vtu_base64", "m.vtu", with(vtu, Coding::inline_base64)},
          {"vtu_zlib", "m.vtu", with(vtu, Coding::inline_zlib)},
          {"vtu_raw", "m.vtu", with(vtu, Coding::raw)},
          {"vtu_raw_zlib", "m.vtu", with(vtu, Coding::raw_zlib)},
          {"vtu_appended_base64", "m.vtu", with(vtu, Coding::appended_base64)},
          {"medit", "m.mesh", with(medit)}};
}

TriMesh small_surface() {
  TriMesh m;
  m.vertices = {{0, 0, 0}, {2, 0, 0}, {0, 3, 0}, {0.5, 0.5, 4}};
  m.triangles = {{0, 2, 1}, {0, 1, 3}, {1, 2, 3}, {2, 0, 3}};
  return m;
}

std::vector<SurfaceFormat> surface_formats() {
  const auto ply_with = [](bool binary) { return [=](const TriMesh& m) { return ply(m, binary); }; };
  return {{"stl_binary", "s.stl", stl_binary},
          {"stl_ascii", "s.stl", stl_ascii},
          {"obj", "s.obj", obj, false},
          {"ply_ascii", "s.ply", ply_with(false)},
          {"ply_binary", "s.ply", ply_with(true)},
          {"off", "s.off", off},
          {"gltf", "s.gltf", gltf},
          {"glb", "s.glb", glb}};
}

}  // namespace insula::test_files
