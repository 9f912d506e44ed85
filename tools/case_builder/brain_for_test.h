// SPDX-License-Identifier: GPL-3.0-or-later
// Brains for tests: three blocks with known borders, as surfaces, and what must hold of any that was meshed.
// Millimetres, MNI.
#pragma once
#include <gtest/gtest.h>

#include "tools/case_builder/brain.h"
#include "tools/case_builder/project.h"
#include "tools/case_builder/shapes_for_test.h"
#include "tools/case_builder/topology.h"

namespace insula::case_builder {

inline const Approach sylvian = read_approach(find_project(INSULA_SOURCE_DIR), "sylvian");
inline const std::array<std::string, 3> lobe_names = sylvian.parts();

/// A box in twelve triangles, outward.
inline TriMesh box(const Vec3& low, const Vec3& high) {
  TriMesh m;
  for (int k = 0; k < 8; ++k)
    m.vertices.emplace_back(k & 1 ? high.x() : low.x(), k & 2 ? high.y() : low.y(), k & 4 ? high.z() : low.z());
  for (const auto& [a, b, c, d] : {std::array{0, 2, 3, 1}, std::array{4, 5, 7, 6}, std::array{0, 1, 5, 4},
                                   std::array{2, 6, 7, 3}, std::array{0, 4, 6, 2}, std::array{1, 3, 7, 5}})
    m.triangles.push_back({a, b, c}), m.triangles.push_back({a, c, d});
  return m;
}

// Three blocks that meet at a fissure in the plane z = -2 and at a floor in the plane x = 40.
inline const Vec3 low_corner(15, -40, -45), high_corner(95, 45, 40);
inline TriMesh block(int lobe) {
  if (lobe == 0) return box({40, low_corner.y(), -2}, high_corner);
  if (lobe == 1) return box({40, low_corner.y(), low_corner.z()}, {high_corner.x(), high_corner.y(), -2});
  return box(low_corner, {40, high_corner.y(), high_corner.z()});
}

class OwnBrain : public testing::Test {
 protected:
  OwnBrain() {
    for (int k = 0; k < 3; ++k) folder.write(std::string(lobe_names[k]) + ".stl", test::stl_text(block(k)));
  }
  std::string path(const std::string& name) const { return (folder.path() / name).string(); }
  Options by_lobe() const {
    Options o;
    for (const std::string& name : lobe_names) o.brain.push_back(name + "=" + path(name + ".stl"));
    return o;
  }
  insula::test::SceneFolder folder;
  std::vector<Note> notes;
};

/// Meshes of both lobes and the floor, closed, that fit into each other.
inline void expect_meshes(const CaseFolder& made, int max_nodes) {
  int nodes = 0;
  for (const char* name : {"frontal", "temporal"}) {
    const TetMesh tets = read_tet_mesh(made.brain() / (std::string(name) + ".msh"), 1.0);
    const TriMesh surface = read_ply(made.brain() / (std::string(name) + "_surface.ply"));
    nodes += int(tets.nodes.size());
    EXPECT_TRUE(border_loops(surface).empty());
    EXPECT_GT(signed_volume(surface), 5000);
    EXPECT_LT(embed(tets, surface.vertices).outside_m, 5);
  }
  EXPECT_TRUE(border_loops(read_ply(made.brain() / "insula_surface.ply")).empty());
  EXPECT_LE(nodes, max_nodes);
  EXPECT_GT(nodes, 150);
}

}  // namespace insula::case_builder
