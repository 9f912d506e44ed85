// SPDX-License-Identifier: GPL-3.0-or-later
// Boxes of tetrahedra, their files, and tools as text.
#include "core/testing/block_mesh.h"

#include <fmt/format.h>

#include <atomic>
#include <fstream>
#include <stdexcept>

#include "core/base/this_process.h"

namespace insula::test {

TetMesh block_mesh(const std::array<int, 3>& cells, const Vec3& low, const Vec3& high) {
  TetMesh m;
  const auto number = [&](const std::array<int, 3>& i) {
    return (i[0] * (cells[1] + 1) + i[1]) * (cells[2] + 1) + i[2];
  };
  std::array<int, 3> i;
  for (i[0] = 0; i[0] <= cells[0]; ++i[0])
    for (i[1] = 0; i[1] <= cells[1]; ++i[1])
      for (i[2] = 0; i[2] <= cells[2]; ++i[2]) {
        Vec3 p;
        for (int a = 0; a < 3; ++a) p[a] = low[a] + (high[a] - low[a]) * i[std::size_t(a)] / cells[std::size_t(a)];
        m.nodes.push_back(p);
      }
  // One tetrahedron for each order of stepping along the axes; odd orders are turned round.
  constexpr std::array<std::array<int, 4>, 6> orders{
      {{0, 1, 2, 0}, {1, 2, 0, 0}, {2, 0, 1, 0}, {0, 2, 1, 1}, {1, 0, 2, 1}, {2, 1, 0, 1}}};
  for (i[0] = 0; i[0] < cells[0]; ++i[0])
    for (i[1] = 0; i[1] < cells[1]; ++i[1])
      for (i[2] = 0; i[2] < cells[2]; ++i[2])
        for (const auto& o : orders) {
          std::array<int, 3> at = i;
          std::array<int, 4> tet{number(at)};
          for (int k = 0; k < 3; ++k) {
            ++at[std::size_t(o[std::size_t(k)])];
            tet[std::size_t(k + 1)] = number(at);
          }
          if (o[3]) std::swap(tet[2], tet[3]);
          m.tets.push_back(tet);
        }
  return m;
}

TetMesh single_tet(double a, const Vec3& at) {
  TetMesh m;
  m.nodes = {at, at + Vec3(a, 0, 0), at + Vec3(0, a, 0), at + Vec3(0, 0, a)};
  m.tets = {{0, 1, 2, 3}};
  return m;
}

std::string gmsh_text(const TetMesh& mesh) {
  std::string out = fmt::format("$MeshFormat\n2.2 0 8\n$EndMeshFormat\n$Nodes\n{}\n", mesh.nodes.size());
  for (std::size_t i = 0; i < mesh.nodes.size(); ++i)
    out += fmt::format("{} {:.17g} {:.17g} {:.17g}\n", i + 1, mesh.nodes[i].x(), mesh.nodes[i].y(), mesh.nodes[i].z());
  out += fmt::format("$EndNodes\n$Elements\n{}\n", mesh.tets.size());
  for (std::size_t t = 0; t < mesh.tets.size(); ++t)
    out += fmt::format("{} 4 2 1 1 {} {} {} {}\n", t + 1, mesh.tets[t][0] + 1, mesh.tets[t][1] + 1, mesh.tets[t][2] + 1,
                       mesh.tets[t][3] + 1);
  return out + "$EndElements\n";
}

std::string obj_text(const TriMesh& mesh) {
  std::string out;
  for (const Vec3& v : mesh.vertices) out += fmt::format("v {:.17g} {:.17g} {:.17g}\n", v.x(), v.y(), v.z());
  for (const auto& t : mesh.triangles) out += fmt::format("f {} {} {}\n", t[0] + 1, t[1] + 1, t[2] + 1);
  return out;
}

SceneFolder::SceneFolder() {
  static std::atomic<int> count{0};
  path_ = std::filesystem::temp_directory_path() / fmt::format("insula_scene_{}_{}", process_id(), count++);
  std::filesystem::create_directories(path_ / "meshes");
}

SceneFolder::~SceneFolder() {
  std::error_code ignored;
  std::filesystem::remove_all(path_, ignored);
}

void SceneFolder::write(const std::string& name, const std::string& text) const {
  std::filesystem::create_directories((path_ / name).parent_path());
  std::ofstream out(path_ / name, std::ios::binary);
  out << text;
  if (!out) throw std::runtime_error("cannot write " + (path_ / name).string());
}

std::string test_tool_urdf(double radius) {
  return fmt::format(R"(<?xml version="1.0"?>
<robot name="test_tool"><link name="tool">
  <inertial><origin xyz="0 0 0.05" rpy="0 0 0"/><mass value="0.02"/>
    <inertia ixx="2e-5" ixy="0" ixz="0" iyy="2e-5" iyz="0" izz="1e-6"/></inertial>
  <visual name="steel"><geometry><sphere radius="{0}"/></geometry></visual>
  <collision name="tip"><geometry><sphere radius="{0}"/></geometry></collision>
</link></robot>
)",
                     radius);
}

std::string test_tool_json(double edge, double inner_radius) {
  std::string out = R"({"unit": "mm", "tip": {"kind": "test")";
  if (inner_radius > 0) out += fmt::format(R"(, "inner_radius_mm": {:.17g})", inner_radius * 1000);
  out += "}";
  if (edge > 0)
    out += fmt::format(R"(, "blade": {{"edge": [[0, {0:.17g}, 0], [0, -{0:.17g}, 0]], "cuts": true}})", edge * 1000);
  return out + "}\n";
}

}  // namespace insula::test
