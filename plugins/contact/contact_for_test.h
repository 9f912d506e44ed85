// SPDX-License-Identifier: GPL-3.0-or-later
// Benches for contact: a tool over a plate, and two tools with two soft blocks.
#pragma once
#include <fmt/format.h>
#include <gtest/gtest.h>

#include "core/collision/shapes/shapes_for_test.h"
#include "core/testing/block_mesh.h"
#include "core/testing/example.h"
#include "plugins/contact/contact.h"

namespace insula::test {

// A tool whose pieces are balls at the corners of a square of half-width `half` around the tip: a block on four feet.
inline std::string feet_urdf(double half, double radius) {
  std::string s = R"(<robot name="feet"><link name="tool"><inertial><mass value="0.02"/>
<inertia ixx="1e-6" iyy="1e-6" izz="1e-6" ixy="0" ixz="0" iyz="0"/></inertial>)";
  for (int i = 0; i < 4; ++i)
    s += fmt::format(
        R"(<collision name="foot_{}"><origin xyz="{} {} 0"/><geometry><sphere radius="{}"/></geometry></collision>)", i,
        i & 1 ? half : -half, i & 2 ? half : -half, radius);
  return s + "</link></robot>";
}

inline std::string rod_urdf(double length, double r) {
  return fmt::format(R"(<robot name="rod"><link name="tool"><inertial><mass value="0.02"/>
<inertia ixx="1e-6" iyy="1e-6" izz="1e-6" ixy="0" ixz="0" iyz="0"/></inertial>
<collision name="rod"><origin xyz="0 0 {}"/><geometry><cylinder length="{}" radius="{}"/></geometry></collision></link></robot>)",
                     0.5 * length, length, r);
}

struct Bench {
  SceneFolder folder;
  std::unique_ptr<Simulation> s;
  Instrument* tool = nullptr;
  Contact* contact = nullptr;

  Bench(const std::string& urdf, const TriMesh& ground, const std::string& tool_attributes,
        const std::string& contact_attributes, const std::string& rest = "") {
    folder.write("meshes/tool/tool.urdf", urdf);
    folder.write("meshes/ground.obj", obj_text(ground));
    s = load_text(fmt::format(R"(<scene title="bench">
<obstacle id="ground"><surface mesh="meshes/ground.obj" mesh_unit="m" material="bone"/></obstacle>
{}<retractor id="tool" model="meshes/tool/tool.urdf" hand="right" {}/>
<solver max_sweeps="10000" tolerance="1e-14 m"/>
<contact id="touch" between="tool ground" {}/></scene>)",
                              rest, tool_attributes, contact_attributes),
                  folder.path() / "scene.xml");
    if (!s) return;
    tool = s->scene().find_as<Instrument>("tool");
    contact = s->scene().find_as<Contact>("touch");
  }
  void hand(const Pose& device) {
    HandState state;
    state.present = true;
    state.device = device;
    s->set_hand(1, state);
  }
  void move_to(const Pose& device) {
    hand(device);
    s->step();
  }
};

inline const std::string upright =
    R"(home="0 0 3 mm" shaft="0 0 1" flat="1 0 0" coupling="400 N/m" angular_coupling="1 N m/rad")";
inline TriMesh ground() { return shapes::box(Vec3(-0.05, -0.05, -0.01), Vec3(0.05, 0.05, 0), 20); }
constexpr double radius = 1e-3;

inline const std::string pad =
    R"(<soft_body id="pad" mesh="meshes/pad.msh" mesh_unit="m"><corotational_fem young="4 kPa"/>
<fixed region="beyond" centre="0 0 -18 mm" normal="0 0 -1"/><surface/></soft_body>)";

inline std::unique_ptr<Simulation> soft_bench(SceneFolder& folder, const std::string& contact) {
  folder.write("meshes/pad.msh", gmsh_text(block_mesh({6, 6, 4}, Vec3(-0.015, -0.015, -0.02), Vec3(0.015, 0.015, 0))));
  folder.write("meshes/top.msh",
               gmsh_text(block_mesh({5, 5, 4}, Vec3(-0.015, -0.015, 0.0008), Vec3(0.015, 0.015, 0.02))));
  folder.write("meshes/tool/tool.urdf", test_tool_urdf(radius));
  return load_text(R"(<scene title="soft">)" + pad + R"(
<soft_body id="top" mesh="meshes/top.msh" mesh_unit="m"><corotational_fem young="4 kPa"/>
<fixed region="beyond" centre="-14 0 0 mm" normal="-1 0 0"/><surface/></soft_body>
<retractor id="left" model="meshes/tool/tool.urdf" hand="left" home="24 0 4 mm" shaft="1 0 0"/>
<retractor id="right" model="meshes/tool/tool.urdf" hand="right" home="0 0 24 mm" shaft="0 0 1" flat="1 0 0"/>
<solver max_sweeps="2000" tolerance="1e-12 m"/>)" +
                       contact + "</scene>",
                   folder.path() / "scene.xml");
}

inline void press(Simulation& s, int i) {
  for (int hand = 0; hand < 2; ++hand) {
    const Instrument* tool = s.instrument_of(hand);
    HandState state;
    state.present = true;
    state.device = tool->home_pose();
    const double in = std::min(i, 60) / 60.0;
    state.device.p += hand == 0 ? Vec3(-0.012 * in, 0.002 * in, 0) : Vec3(0.002 * in, 0, -0.009 * in);
    s.set_hand(hand, state);
  }
}

}  // namespace insula::test
