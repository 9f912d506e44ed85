// SPDX-License-Identifier: GPL-3.0-or-later
// Quality, topology and files of plain meshes.
#include "mesh_data.h"

#include <algorithm>
#include <bit>
#include <cstdio>
#include <cstring>
#include <fstream>
#include <map>
#include <numbers>
#include <stdexcept>

namespace insula::mesh_tool {
namespace {

static_assert(std::endian::native == std::endian::little, "binary files are written as they lie in memory");

struct Out {
  std::ofstream stream;
  std::string path;
  explicit Out(const std::string& file) : stream(file, std::ios::binary), path(file) {
    if (!stream) throw std::runtime_error(file + ": cannot be written");
  }
  void text(const std::string& s) { stream.write(s.data(), static_cast<std::streamsize>(s.size())); }
  template <class T>
  void raw(T value) {
    stream.write(reinterpret_cast<const char*>(&value), sizeof value);
  }
  void finish() {
    stream.flush();
    if (!stream) throw std::runtime_error(path + ": writing failed");
  }
};

std::string coordinates(const Vec3& p) {
  char line[96];
  std::snprintf(line, sizeof line, "%.6f %.6f %.6f", p[0], p[1], p[2]);
  return line;
}

}  // namespace

DihedralRange dihedral_range(const Vec3& a, const Vec3& b, const Vec3& c, const Vec3& d) {
  const Vec3 p[4] = {a, b, c, d};
  if (dot(cross(b - a, c - a), d - a) <= 0) return {-1, 181};
  // Outward normal of the face opposite each vertex.
  static constexpr int face[4][3] = {{1, 2, 3}, {0, 3, 2}, {0, 1, 3}, {0, 2, 1}};
  Vec3 normal[4];
  for (int f = 0; f < 4; ++f) {
    const Vec3 n = cross(p[face[f][1]] - p[face[f][0]], p[face[f][2]] - p[face[f][0]]);
    normal[f] = (1 / norm(n)) * n;
  }
  DihedralRange range;
  for (int i = 0; i < 4; ++i)
    for (int j = i + 1; j < 4; ++j) {
      const double angle = std::acos(std::clamp(-dot(normal[i], normal[j]), -1.0, 1.0)) * 180 / std::numbers::pi;
      range.min_deg = std::min(range.min_deg, angle);
      range.max_deg = std::max(range.max_deg, angle);
    }
  return range;
}

DihedralRange dihedral_range(const TetMesh& mesh) {
  DihedralRange range;
  for (const Tet& t : mesh.tets) {
    const auto p = [&](std::size_t i) { return mesh.points[static_cast<std::size_t>(t[i])]; };
    const DihedralRange r = dihedral_range(p(0), p(1), p(2), p(3));
    range.min_deg = std::min(range.min_deg, r.min_deg);
    range.max_deg = std::max(range.max_deg, r.max_deg);
  }
  return range;
}

double volume(const TetMesh& mesh) {
  double sum = 0;
  for (const Tet& t : mesh.tets) {
    const Vec3& o = mesh.points[static_cast<std::size_t>(t[0])];
    sum += dot(cross(mesh.points[static_cast<std::size_t>(t[1])] - o, mesh.points[static_cast<std::size_t>(t[2])] - o),
               mesh.points[static_cast<std::size_t>(t[3])] - o) /
           6;
  }
  return sum;
}

double signed_volume(const TriangleMesh& mesh) {
  double sum = 0;
  for (const Triangle& t : mesh.triangles)
    sum += dot(mesh.points[static_cast<std::size_t>(t[0])],
               cross(mesh.points[static_cast<std::size_t>(t[1])], mesh.points[static_cast<std::size_t>(t[2])])) /
           6;
  return sum;
}

std::vector<Triangle> boundary_triangles(const TetMesh& mesh) {
  static constexpr int face[4][3] = {{1, 2, 3}, {0, 3, 2}, {0, 1, 3}, {0, 2, 1}};
  std::map<Triangle, std::pair<int, Triangle>> seen;
  for (const Tet& t : mesh.tets)
    for (const auto& f : face) {
      const Triangle tri{t[static_cast<std::size_t>(f[0])], t[static_cast<std::size_t>(f[1])],
                         t[static_cast<std::size_t>(f[2])]};
      Triangle key = tri;
      std::sort(key.begin(), key.end());
      auto& entry = seen[key];
      ++entry.first;
      entry.second = tri;
    }
  std::vector<Triangle> out;
  for (const auto& [key, entry] : seen)
    if (entry.first == 1) out.push_back(entry.second);
  return out;
}

bool is_closed(const std::vector<Triangle>& triangles) {
  std::map<std::pair<int, int>, int> edges;
  for (const Triangle& t : triangles)
    for (std::size_t e = 0; e < 3; ++e) ++edges[{t[e], t[(e + 1) % 3]}];
  for (const auto& [edge, count] : edges) {
    const auto back = edges.find({edge.second, edge.first});
    if (count != 1 || back == edges.end() || back->second != 1) return false;
  }
  return !triangles.empty();
}

std::size_t keep_largest_component(TriangleMesh& mesh) {
  const std::size_t n = mesh.triangles.size();
  std::map<std::pair<int, int>, std::vector<std::size_t>> edges;
  for (std::size_t i = 0; i < n; ++i)
    for (std::size_t e = 0; e < 3; ++e) {
      const int a = mesh.triangles[i][e], b = mesh.triangles[i][(e + 1) % 3];
      edges[{std::min(a, b), std::max(a, b)}].push_back(i);
    }
  std::vector<int> label(n, 0);
  int next = 0, best = 0;
  std::size_t best_size = 0;
  for (std::size_t start = 0; start < n; ++start) {
    if (label[start]) continue;
    std::vector<std::size_t> stack{start};
    label[start] = ++next;
    std::size_t size = 0;
    while (!stack.empty()) {
      const std::size_t at = stack.back();
      stack.pop_back();
      ++size;
      for (std::size_t e = 0; e < 3; ++e) {
        const int a = mesh.triangles[at][e], b = mesh.triangles[at][(e + 1) % 3];
        for (const std::size_t to : edges[{std::min(a, b), std::max(a, b)}])
          if (!label[to]) label[to] = next, stack.push_back(to);
      }
    }
    if (size > best_size) best_size = size, best = next;
  }
  TriangleMesh kept;
  std::vector<int> renumber(mesh.points.size(), -1);
  for (std::size_t i = 0; i < n; ++i) {
    if (label[i] != best) continue;
    Triangle t = mesh.triangles[i];
    for (int& v : t) {
      int& to = renumber[static_cast<std::size_t>(v)];
      if (to < 0) {
        to = static_cast<int>(kept.points.size());
        kept.points.push_back(mesh.points[static_cast<std::size_t>(v)]);
      }
      v = to;
    }
    kept.triangles.push_back(t);
  }
  mesh = std::move(kept);
  return n - mesh.triangles.size();
}

void drop_unused_points(TetMesh& mesh) {
  std::vector<int> renumber(mesh.points.size(), -1);
  std::vector<Vec3> points;
  for (Tet& t : mesh.tets)
    for (int& v : t) {
      int& to = renumber[static_cast<std::size_t>(v)];
      if (to < 0) to = static_cast<int>(points.size()), points.push_back(mesh.points[static_cast<std::size_t>(v)]);
      v = to;
    }
  mesh.points = std::move(points);
}

std::size_t keep_largest_component(TetMesh& mesh) {
  const std::size_t n = mesh.tets.size();
  std::map<Triangle, std::vector<std::size_t>> faces;
  const auto face = [&](std::size_t i, std::size_t f) {
    Triangle key{mesh.tets[i][(f + 1) % 4], mesh.tets[i][(f + 2) % 4], mesh.tets[i][(f + 3) % 4]};
    std::sort(key.begin(), key.end());
    return key;
  };
  for (std::size_t i = 0; i < n; ++i)
    for (std::size_t f = 0; f < 4; ++f) faces[face(i, f)].push_back(i);
  std::vector<int> label(n, 0);
  int next = 0, best = 0;
  std::size_t best_size = 0;
  for (std::size_t start = 0; start < n; ++start) {
    if (label[start]) continue;
    std::vector<std::size_t> stack{start};
    label[start] = ++next;
    std::size_t size = 0;
    while (!stack.empty()) {
      const std::size_t i = stack.back();
      stack.pop_back();
      ++size;
      for (std::size_t f = 0; f < 4; ++f)
        for (const std::size_t to : faces[face(i, f)])
          if (!label[to]) label[to] = next, stack.push_back(to);
    }
    if (size > best_size) best_size = size, best = next;
  }
  std::vector<Tet> kept;
  for (std::size_t i = 0; i < n; ++i)
    if (label[i] == best) kept.push_back(mesh.tets[i]);
  mesh.tets = std::move(kept);
  drop_unused_points(mesh);
  return n - mesh.tets.size();
}

void write_msh(const std::string& path, const TetMesh& mesh, MshFormat format) {
  Out out(path);
  const std::size_t n = mesh.points.size(), m = mesh.tets.size();
  if (format == MshFormat::v2_ascii) {
    out.text("$MeshFormat\n2.2 0 8\n$EndMeshFormat\n$Nodes\n" + std::to_string(n) + "\n");
    for (std::size_t i = 0; i < n; ++i) out.text(std::to_string(i + 1) + " " + coordinates(mesh.points[i]) + "\n");
    out.text("$EndNodes\n$Elements\n" + std::to_string(m) + "\n");
    for (std::size_t i = 0; i < m; ++i) {
      out.text(std::to_string(i + 1) + " 4 2 1 1");
      for (const int v : mesh.tets[i]) out.text(" " + std::to_string(v + 1));
      out.text("\n");
    }
    out.text("$EndElements\n");
    return out.finish();
  }
  Vec3 low = mesh.points.at(0), high = low;
  for (const Vec3& p : mesh.points)
    for (std::size_t a = 0; a < 3; ++a) low[a] = std::min(low[a], p[a]), high[a] = std::max(high[a], p[a]);
  if (format == MshFormat::v4_ascii) {
    const std::string count = std::to_string(n), cells = std::to_string(m);
    out.text("$MeshFormat\n4.1 0 8\n$EndMeshFormat\n$Entities\n0 0 0 1\n1 " + coordinates(low) + " " +
             coordinates(high) + " 0 0\n$EndEntities\n$Nodes\n1 " + count + " 1 " + count + "\n3 1 0 " + count + "\n");
    for (std::size_t i = 0; i < n; ++i) out.text(std::to_string(i + 1) + "\n");
    for (const Vec3& p : mesh.points) out.text(coordinates(p) + "\n");
    out.text("$EndNodes\n$Elements\n1 " + cells + " 1 " + cells + "\n3 1 4 " + cells + "\n");
    for (std::size_t i = 0; i < m; ++i) {
      out.text(std::to_string(i + 1));
      for (const int v : mesh.tets[i]) out.text(" " + std::to_string(v + 1));
      out.text("\n");
    }
    out.text("$EndElements\n");
    return out.finish();
  }
  using Size = std::uint64_t;
  out.text("$MeshFormat\n4.1 1 8\n");
  out.raw(std::int32_t{1});
  out.text("\n$EndMeshFormat\n$Entities\n");
  for (const Size s : {Size{0}, Size{0}, Size{0}, Size{1}}) out.raw(s);
  out.raw(std::int32_t{1});
  for (const double v : {low[0], low[1], low[2], high[0], high[1], high[2]}) out.raw(v);
  out.raw(Size{0});
  out.raw(Size{0});
  out.text("\n$EndEntities\n$Nodes\n");
  for (const Size s : {Size{1}, Size{n}, Size{1}, Size{n}}) out.raw(s);
  for (const std::int32_t v : {3, 1, 0}) out.raw(v);
  out.raw(Size{n});
  for (std::size_t i = 0; i < n; ++i) out.raw(Size{i + 1});
  for (const Vec3& p : mesh.points)
    for (const double v : p) out.raw(v);
  out.text("\n$EndNodes\n$Elements\n");
  for (const Size s : {Size{1}, Size{m}, Size{1}, Size{m}}) out.raw(s);
  for (const std::int32_t v : {3, 1, 4}) out.raw(v);
  out.raw(Size{m});
  for (std::size_t i = 0; i < m; ++i) {
    out.raw(Size{i + 1});
    for (const int v : mesh.tets[i]) out.raw(Size{static_cast<std::size_t>(v) + 1});
  }
  out.text("\n$EndElements\n");
  out.finish();
}

void write_ply(const std::string& path, const TriangleMesh& mesh) {
  std::vector<Vec3> normals(mesh.points.size(), Vec3{});
  for (const Triangle& t : mesh.triangles) {
    const auto p = [&](std::size_t i) { return mesh.points[static_cast<std::size_t>(t[i])]; };
    const Vec3 area = cross(p(1) - p(0), p(2) - p(0));
    for (const int v : t) normals[static_cast<std::size_t>(v)] = normals[static_cast<std::size_t>(v)] + area;
  }
  Out out(path);
  out.text(
      "ply\nformat binary_little_endian 1.0\ncomment unit mm, right-anterior-superior axes of the label "
      "volume\nelement vertex " +
      std::to_string(mesh.points.size()) +
      "\nproperty float x\nproperty float y\nproperty float z\nproperty float nx\nproperty float ny\nproperty float "
      "nz\n"
      "element face " +
      std::to_string(mesh.triangles.size()) + "\nproperty list uchar int vertex_indices\nend_header\n");
  for (std::size_t i = 0; i < mesh.points.size(); ++i) {
    const double length = norm(normals[i]);
    const Vec3 unit = length > 0 ? (1 / length) * normals[i] : Vec3{0, 0, 1};
    for (const double v : mesh.points[i]) out.raw(static_cast<float>(v));
    for (const double v : unit) out.raw(static_cast<float>(v));
  }
  for (const Triangle& t : mesh.triangles) {
    out.raw(std::uint8_t{3});
    for (const int v : t) out.raw(static_cast<std::int32_t>(v));
  }
  out.finish();
}

}  // namespace insula::mesh_tool
