// SPDX-License-Identifier: GPL-3.0-or-later
// Vessels for tests, made from functions: a straight tube with a sac, and what can be wrong with such a surface.
// Millimetres.
#pragma once
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <fstream>
#include <functional>
#include <map>
#include <string>

#include "core/testing/block_mesh.h"
#include "tools/artery/surface.h"
#include "tools/case_builder/topology.h"

namespace insula::case_builder::test {

/// A tube of radius 1.4 along x from -8 to 8, its ends flat, with a ball of radius 2.4 on a neck above its middle.
/// Closed.
inline TriMesh tube_with_sac(double step = 0.35) {
  const auto value = [](const Vec3& p) {
    const double tube = std::hypot(p.y(), p.z()) - 1.4, ball = (p - Vec3(0, 0, 3.6)).norm() - 2.4, k = 0.5;
    const double w = std::max(k - std::abs(tube - ball), 0.0) / k;
    return std::min(tube, ball) - 0.25 * w * w * k;
  };
  TriMesh long_one = artery::extract(value, Vec3(-9.03, -3.01, -2.02), Vec3(9.07, 3.05, 7.1), step);
  artery::Surface s{long_one, std::vector<int>(long_one.triangles.size(), -1), {}};
  // The box has cut it open: the ends are cut flat.
  artery::cut_and_close(s, {"a", Vec3(-8, 0, 0), Vec3(-1, 0, 0), 1.4}, 3.0);
  artery::cut_and_close(s, {"b", Vec3(8, 0, 0), Vec3(1, 0, 0), 1.4}, 3.0);
  return s.mesh;
}

/// Without the flat ends.
inline TriMesh open_tube(double step = 0.35) {
  TriMesh m = tube_with_sac(step);
  std::erase_if(m.triangles, [&](const auto& t) {
    for (const int v : t)
      if (std::abs(std::abs(m.vertices[std::size_t(v)].x()) - 8) > 1e-6) return false;
    return true;
  });
  artery::number_by_use(m);
  return m;
}

/// Triangles whose centres fulfil a condition go.
inline TriMesh without(TriMesh m, const std::function<bool(const Vec3&)>& gone) {
  std::erase_if(m.triangles, [&](const auto& t) {
    return gone((m.vertices[std::size_t(t[0])] + m.vertices[std::size_t(t[1])] + m.vertices[std::size_t(t[2])]) / 3);
  });
  artery::number_by_use(m);
  return m;
}

inline TriMesh joined(TriMesh a, const TriMesh& b, const Vec3& shift, double scale = 1) {
  const int first = int(a.vertices.size());
  for (const Vec3& p : b.vertices) a.vertices.push_back(scale * p + shift);
  for (const auto& t : b.triangles) a.triangles.push_back({first + t[0], first + t[1], first + t[2]});
  return a;
}

inline TriMesh scaled(TriMesh m, double factor) {
  for (Vec3& p : m.vertices) p *= factor;
  return m;
}

inline std::string stl_text(const TriMesh& m) {
  std::string s(80, ' ');
  const auto add = [&s](auto v) { s.append(reinterpret_cast<const char*>(&v), sizeof v); };
  add(std::uint32_t(m.triangles.size()));
  for (const auto& t : m.triangles) {
    for (int k = 0; k < 3; ++k) add(0.0f);
    for (const int v : t)
      for (int k = 0; k < 3; ++k) add(float(m.vertices[std::size_t(v)][k]));
    add(std::uint16_t(0));
  }
  return s;
}

inline std::string obj_text(const TriMesh& m) {
  std::string s;
  for (const Vec3& p : m.vertices)
    s += "v " + std::to_string(p.x()) + " " + std::to_string(p.y()) + " " + std::to_string(p.z()) + "\n";
  for (const auto& t : m.triangles)
    s += "f " + std::to_string(t[0] + 1) + " " + std::to_string(t[1] + 1) + " " + std::to_string(t[2] + 1) + "\n";
  return s;
}

inline std::string vtp_text(const TriMesh& m) {
  std::string points, nodes, offsets;
  for (const Vec3& p : m.vertices)
    points += std::to_string(p.x()) + " " + std::to_string(p.y()) + " " + std::to_string(p.z()) + "\n";
  for (std::size_t t = 0; t < m.triangles.size(); ++t) {
    for (const int v : m.triangles[t]) nodes += std::to_string(v) + " ";
    offsets += std::to_string(3 * t + 3) + " ";
  }
  return "<?xml version=\"1.0\"?>\n<VTKFile type=\"PolyData\" version=\"0.1\" "
         "byte_order=\"LittleEndian\"><PolyData><Piece NumberOfPoints=\"" +
         std::to_string(m.vertices.size()) + "\" NumberOfPolys=\"" + std::to_string(m.triangles.size()) +
         "\"><Points><DataArray type=\"Float32\" NumberOfComponents=\"3\" format=\"ascii\">" + points +
         "</DataArray></Points><Polys><DataArray type=\"Int32\" Name=\"connectivity\" format=\"ascii\">" + nodes +
         "</DataArray><DataArray type=\"Int32\" Name=\"offsets\" format=\"ascii\">" + offsets +
         "</DataArray></Polys></Piece></PolyData></VTKFile>\n";
}

/// Tetrahedra that fill a part of a grid: six to a cube whose middle is inside. Every other one is turned inside out,
/// as FEniCS leaves them.
inline TetMesh filled(const Vec3& from, const Vec3& to, double spacing,
                      const std::function<bool(const Vec3&)>& inside) {
  TetMesh m;
  std::map<std::array<int, 3>, int> at;
  const auto node = [&](int i, int j, int k) {
    const auto [it, fresh] = at.try_emplace({i, j, k}, int(m.nodes.size()));
    if (fresh) m.nodes.push_back(from + spacing * Vec3(i, j, k));
    return it->second;
  };
  const Vec3 n = (to - from) / spacing;
  for (int k = 0; k < n.z(); ++k)
    for (int j = 0; j < n.y(); ++j)
      for (int i = 0; i < n.x(); ++i) {
        if (!inside(from + spacing * Vec3(i + 0.5, j + 0.5, k + 0.5))) continue;
        std::array<int, 3> axis{0, 1, 2};
        do {  // along the cube's edges from its first corner to its last
          std::array<int, 3> p{i, j, k};
          std::array<int, 4> tet{node(i, j, k), 0, 0, 0};
          for (std::size_t s = 0; s < 3; ++s) ++p[std::size_t(axis[s])], tet[s + 1] = node(p[0], p[1], p[2]);
          m.tets.push_back(tet);
        } while (std::next_permutation(axis.begin(), axis.end()));
      }
  return m;
}
/// A tube with a sac on top, filled, with flat ends.
inline TetMesh filled_tube(double spacing = 0.4) {
  return filled(Vec3(-8, -2.8, -2.8), Vec3(8, 2.8, 6.4), spacing,
                [](const Vec3& p) { return std::hypot(p.y(), p.z()) < 1.4 || (p - Vec3(0, 0, 3.4)).norm() < 2.4; });
}

/// A .vtu file: the tetrahedra, and after them some faces (type 5).
inline std::string vtu_text(const TetMesh& m, const std::vector<std::array<int, 3>>& faces = {}) {
  std::string points, nodes, offsets, types;
  for (const Vec3& p : m.nodes)
    points += std::to_string(p.x()) + " " + std::to_string(p.y()) + " " + std::to_string(p.z()) + "\n";
  std::size_t end = 0;
  const auto add = [&](const auto& cell, const char* type) {
    for (const int v : cell) nodes += std::to_string(v) + " ";
    offsets += std::to_string(end += cell.size()) + " ", types += type;
  };
  for (const auto& t : m.tets) add(t, "10 ");
  for (const auto& t : faces) add(t, "5 ");
  const auto array = [](const char* type, const char* name, const std::string& values) {
    return std::string("<DataArray type=\"") + type + "\" Name=\"" + name + "\" format=\"ascii\">" + values +
           "</DataArray>";
  };
  return "<?xml version=\"1.0\"?>\n<VTKFile type=\"UnstructuredGrid\" version=\"0.1\" "
         "byte_order=\"LittleEndian\"><UnstructuredGrid><Piece NumberOfPoints=\"" +
         std::to_string(m.nodes.size()) + "\" NumberOfCells=\"" + std::to_string(m.tets.size() + faces.size()) +
         "\"><Points><DataArray type=\"Float64\" NumberOfComponents=\"3\" format=\"ascii\">" + points +
         "</DataArray></Points><Cells>" + array("Int64", "connectivity", nodes) + array("Int64", "offsets", offsets) +
         array("UInt8", "types", types) + "</Cells></Piece></UnstructuredGrid></VTKFile>\n";
}

/// A NIfTI file of bytes; `value` at voxel indices, the first of which lies at `origin`.
inline std::string nifti_text(std::array<int, 3> n, double spacing, const std::function<int(int, int, int)>& value,
                              int times = 1, const Vec3& origin = Vec3::Zero()) {
  std::string h(352, '\0');
  const auto put = [&h](std::size_t at, auto v) { std::memcpy(h.data() + at, &v, sizeof v); };
  put(0, std::int32_t(348));
  const std::int16_t dim[8] = {std::int16_t(times > 1 ? 4 : 3),
                               std::int16_t(n[0]),
                               std::int16_t(n[1]),
                               std::int16_t(n[2]),
                               std::int16_t(times),
                               1,
                               1,
                               1};
  for (std::size_t k = 0; k < 8; ++k) put(40 + 2 * k, dim[k]);
  put(70, std::int16_t(2)), put(72, std::int16_t(8));
  for (std::size_t k = 0; k < 8; ++k) put(76 + 4 * k, k >= 1 && k <= 3 ? float(spacing) : 1.0f);
  put(108, 352.0f), put(112, 1.0f);
  h[123] = 2;  // millimetres
  put(254, std::int16_t(1));
  for (std::size_t r = 0; r < 3; ++r)
    put(280 + 16 * r + 4 * r, float(spacing)), put(280 + 16 * r + 12, float(origin[Eigen::Index(r)]));
  std::memcpy(h.data() + 344, "n+1", 4);
  for (int t = 0; t < times; ++t)
    for (int k = 0; k < n[2]; ++k)
      for (int j = 0; j < n[1]; ++j)
        for (int i = 0; i < n[0]; ++i) h.push_back(char(value(i, j, k)));
  return h;
}

/// Labels of the right half of a head in the MNI frame. Its Sylvian fissure lies where that of the shipped lobes lies.
/// The parts are a ball of cortex, a bump of insula (30) under it, and a bent sheet of fissure between the gyri of the
/// frontal lobe (2, 4 to 6) and the temporal lobe (81). `shift` (mm) moves all of it.
inline int head_label(Vec3 p, const Vec3& shift = Vec3::Zero()) {
  p -= shift;
  if (p.x() < 0 || (p - Vec3(0, -12, -4)).norm() > 70) return 0;
  if (((p - Vec3(20, 3, -2)).array() / Eigen::Array3d(29, 30, 25)).matrix().norm() < 1 || p.x() < 15) return 30;
  // Inward the fissure goes back and down; along its opening it falls towards the front, the faster the farther.
  const double y = p.y() + 0.28 * (60 - p.x()), z = p.z() + 0.28 * (60 - p.x());
  if (z < -3.3 - 0.4 * (y - 16.3) - 0.65 * std::max(0.0, y - 18)) return 81;
  return p.y() > 20 ? 2 : p.z() > 25 ? 4 : p.y() > 0 ? 5 : 6;
}
inline std::string head_text(const Vec3& shift = Vec3::Zero()) {
  const Vec3 first(-4.5, -55, -58);
  constexpr double voxel = 1.5;
  return nifti_text(
      {54, 78, 78}, voxel, [&](int i, int j, int k) { return head_label(first + voxel * Vec3(i, j, k), shift); }, 1,
      first);
}

/// One slice of a DICOM series, 16 bits, explicit little endian.
inline std::string dicom_text(std::array<int, 2> n, double spacing, int slice,
                              const std::function<int(int, int)>& value, const std::string& series = "1.2.3.6",
                              const std::string& person = "") {
  std::string s(128, '\0');
  s += "DICM";
  const auto put = [](std::string& to, auto v) { to.append(reinterpret_cast<const char*>(&v), sizeof v); };
  const auto element = [&put](std::string& to, unsigned group, unsigned number, const char* kind, std::string data) {
    if (data.size() % 2) data += kind[0] == 'U' ? '\0' : ' ';
    put(to, std::uint16_t(group)), put(to, std::uint16_t(number));
    to += kind;
    if (std::string(kind) == "OW" || std::string(kind) == "OB")
      put(to, std::uint16_t(0)), put(to, std::uint32_t(data.size()));
    else put(to, std::uint16_t(data.size()));
    to += data;
  };
  const auto number = [&put](int v) {
    std::string t;
    put(t, std::uint16_t(v));
    return t;
  };
  const std::string place = std::to_string(spacing * slice), same = std::to_string(spacing),
                    id = "1.2.3.4." + std::to_string(slice + 1), ct = "1.2.840.10008.5.1.4.1.1.2";
  std::string meta;
  element(meta, 2, 1, "OB", std::string("\0\1", 2));
  element(meta, 2, 2, "UI", ct), element(meta, 2, 3, "UI", id), element(meta, 2, 0x10, "UI", "1.2.840.10008.1.2.1"),
      element(meta, 2, 0x12, "UI", "1.2.3.9");
  std::string length;
  put(length, std::uint32_t(meta.size()));
  element(s, 2, 0, "UL", length);
  s += meta;
  element(s, 8, 0x16, "UI", ct), element(s, 8, 0x18, "UI", id), element(s, 8, 0x60, "CS", "CT");
  if (!person.empty()) element(s, 0x10, 0x10, "PN", person), element(s, 0x10, 0x20, "LO", person);
  element(s, 0x18, 0x50, "DS", same);
  element(s, 0x20, 0xD, "UI", "1.2.3.5"), element(s, 0x20, 0xE, "UI", series),
      element(s, 0x20, 0x13, "IS", std::to_string(slice + 1));
  element(s, 0x20, 0x32, "DS", "0\\0\\" + place), element(s, 0x20, 0x37, "DS", "1\\0\\0\\0\\1\\0");
  element(s, 0x28, 2, "US", number(1)), element(s, 0x28, 4, "CS", "MONOCHROME2"),
      element(s, 0x28, 0x10, "US", number(n[1])), element(s, 0x28, 0x11, "US", number(n[0]));
  element(s, 0x28, 0x30, "DS", same + "\\" + same);
  element(s, 0x28, 0x100, "US", number(16)), element(s, 0x28, 0x101, "US", number(16)),
      element(s, 0x28, 0x102, "US", number(15)), element(s, 0x28, 0x103, "US", number(0));
  std::string pixels;
  for (int j = 0; j < n[1]; ++j)
    for (int i = 0; i < n[0]; ++i) put(pixels, std::uint16_t(value(i, j)));
  element(s, 0x7FE0, 0x10, "OW", pixels);
  return s;
}

/// The tube with its sac as labels: 1 inside, reaching through the whole volume along x.
inline int tube_label(int i, int j, int k, double spacing = 0.3) {
  const Vec3 p(spacing * i - 8, spacing * j - 3.6, spacing * k - 2.4);
  return std::hypot(p.y(), p.z()) < 1.4 || (p - Vec3(0, 0, 3.4)).norm() < 2.4;
}

}  // namespace insula::case_builder::test
