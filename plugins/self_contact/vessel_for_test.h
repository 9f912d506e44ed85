// SPDX-License-Identifier: GPL-3.0-or-later
// A thin tube fixed at both ends, flat tools that approach it, and forbidden states: walls through walls, tools inside.
#pragma once
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <set>

#include "core/collision/shapes/shapes_for_test.h"
#include "core/mechanics/shell_body.h"
#include "core/testing/block_mesh.h"
#include "core/testing/example.h"
#include "plugins/contact/contact.h"
#include "plugins/self_contact/self_contact.h"

namespace insula::test {

/// Closed tube along x, `around` vertices a ring and about square cells; both ends closed by fans.
inline TriMesh tube(double radius, double length, int around) {
  TriMesh m;
  const int rings = std::max(2, int(std::lround(length / (2 * M_PI * radius / around)))) + 1;
  for (int i = 0; i < rings; ++i)
    for (int k = 0; k < around; ++k) {
      const double a = 2 * M_PI * (k + 0.5 * (i % 2)) / around;
      m.vertices.push_back({length * (double(i) / (rings - 1) - 0.5), radius * std::cos(a), radius * std::sin(a)});
    }
  for (int i = 0; i + 1 < rings; ++i)
    for (int k = 0; k < around; ++k) {
      const int a = i * around + k, b = i * around + (k + 1) % around, c = a + around, d = b + around;
      if (i % 2 == 0) {
        m.triangles.push_back({a, b, c});
        m.triangles.push_back({b, d, c});
      } else {
        m.triangles.push_back({a, d, c});
        m.triangles.push_back({a, b, d});
      }
    }
  for (int side = 0; side < 2; ++side) {
    const int centre = int(m.vertices.size()), first = side * (rings - 1) * around;
    m.vertices.push_back({(side - 0.5) * length, 0, 0});
    for (int k = 0; k < around; ++k) {
      const int a = first + k, b = first + (k + 1) % around;
      if (side == 0) m.triangles.push_back({centre, b, a});
      else m.triangles.push_back({centre, a, b});
    }
  }
  return m;
}

/// A tool of one box: `across` along its x (the flat side's normal), `wide` along y, from the tip up along z.
inline std::string box_urdf(double across, double wide, double length) {
  return fmt::format(R"(<robot name="blade"><link name="tool"><inertial><origin xyz="0 0 {}"/><mass value="0.02"/>
<inertia ixx="1e-6" iyy="1e-6" izz="1e-6" ixy="0" ixz="0" iyz="0"/></inertial>
<collision name="blade"><origin xyz="0 0 {}"/><geometry><box size="{} {} {}"/></geometry></collision></link></robot>)",
                     0.5 * length, 0.5 * length, across, wide, length);
}

struct VesselBench {
  SceneFolder folder;
  std::unique_ptr<Simulation> s;
  ShellBody* shell = nullptr;
  SelfContact* self = nullptr;
  Contact* touch = nullptr;
  std::set<std::pair<int, int>> edges;

  VesselBench(const TriMesh& vessel, double half_length, const std::string& tools, const std::string& between,
              const std::string& contact, const std::string& self_contact, double sweeps = 200) {
    folder.write("meshes/vessel.obj", obj_text(vessel));
    folder.write("meshes/blade/tool.urdf", box_urdf(0.4e-3, 4e-3, 12e-3));
    folder.write("meshes/ball/tool.urdf", test_tool_urdf(1e-3));
    folder.write("meshes/jaw/tool.urdf", box_urdf(1e-3, 1.5e-3, 9e-3));
    s = load_text(fmt::format(R"(<scene><solver max_sweeps="{}" tolerance="1e-9 m"/>
<shell_body id="vessel" mesh="meshes/vessel.obj" mesh_unit="m"><membrane thickness="0.3 mm" young="1 MPa"/>
<fixed region="beyond" centre="{} 0 0 m" normal="1 0 0"/><fixed region="beyond" centre="-{} 0 0 m" normal="-1 0 0"/>
<surface id="wall" material="vessel" thickness="0.3 mm"/></shell_body>
{}<contact id="touch" between="{} vessel" {}/><self_contact id="self" on="wall" {}/></scene>)",
                              sweeps, half_length, half_length, tools, between, contact, self_contact),
                  folder.path() / "scene.xml");
    if (!s) return;
    shell = s->scene().find_as<ShellBody>("vessel");
    self = s->scene().find_as<SelfContact>("self");
    touch = s->scene().find_as<Contact>("touch");
    for (const auto& t : shell->rest().triangles)
      for (int k = 0; k < 3; ++k) edges.insert(std::minmax(t[std::size_t(k)], t[std::size_t((k + 1) % 3)]));
    now_.build(shell->rest().vertices, shell->rest().triangles);
  }

  void hand(int which, const Pose& device) {
    HandState state;
    state.present = true;
    state.device = device;
    s->set_hand(which, state);
  }
  /// The vessel in its current shape.
  const CollisionMesh& now() {
    places_.resize(shell->rest().vertices.size());
    for (std::size_t i = 0; i < places_.size(); ++i) places_[i] = shell->q().segment<3>(3 * std::ptrdiff_t(i));
    now_.update(places_, {});
    return now_;
  }
  /// Edges that pass through triangles which do not share a vertex with them.
  int crossings() {
    const CollisionMesh& m = now();
    int count = 0;
    for (const auto& [a, b] : edges) {
      Aabb box;
      box.add(places_[std::size_t(a)]);
      box.add(places_[std::size_t(b)]);
      m.tree().overlapping(box, [&, a = a, b = b](int tri) {
        const auto& t = m.triangle(tri);
        for (int v : t)
          if (v == a || v == b) return;
        count += segment_triangle(places_[std::size_t(a)], places_[std::size_t(b)], m.vertex(t[0]), m.vertex(t[1]),
                                  m.vertex(t[2]))
                     .distance2 == 0;
      });
    }
    return count;
  }
  /// How deep the deepest point of a tool's cores is inside the vessel, m; 0: outside. Includes points of the cores'
  /// edges.
  double depth(const Instrument& tool) {
    const CollisionMesh& m = now();
    double deepest = 0;
    for (const ConvexPiece& piece : tool.tool().pieces) {
      const RoundedPiece r = rounded(piece);
      for (std::size_t i = 0; i < r.core.size(); ++i)
        for (std::size_t j = 0; j <= i; ++j)
          for (int k = 0; k <= 8; ++k) {
            const Vec3 p = tool.pose().apply(r.core[i] + k / 8.0 * (r.core[j] - r.core[i]));
            const NearestPoint e = m.nearest(p, 0, 5e-3);
            if (e.triangle >= 0 && e.behind) deepest = std::max(deepest, e.distance);
          }
    }
    return deepest;
  }

 private:
  std::vector<Vec3> places_;
  CollisionMesh now_;
};

}  // namespace insula::test
