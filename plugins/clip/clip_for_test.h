// SPDX-License-Identifier: GPL-3.0-or-later
// A plain clip (two boxes on a hinge) and a test bench for it.
#pragma once
#include <fmt/format.h>
#include <gtest/gtest.h>

#include "core/collision/shapes/shapes_for_test.h"
#include "core/testing/block_mesh.h"
#include "core/testing/example.h"
#include "plugins/clip/clip.h"
#include "plugins/clip/clip_applier.h"

namespace insula::test {

constexpr double hinge_z = 14e-3, reference = 9.5e-3, closing = 1.5, slope = 300, widest = 0.4;  // SI

inline std::string jaw_urdf(const std::string& name, double side) {
  return fmt::format(R"(<link name="{}"><inertial><origin xyz="{} 0 -0.0095"/><mass value="0.00005"/>
<inertia ixx="8e-10" iyy="8e-10" izz="3e-11" ixy="0" ixz="0" iyz="0"/></inertial>
<collision name="{}_blade"><origin xyz="{} 0 -0.0095"/><geometry><box size="0.0008 0.0013 0.009"/></geometry></collision></link>)",
                     name, side * 4e-4, name, side * 4e-4);
}

inline std::string clip_urdf() {
  return R"(<robot name="plain"><link name="body"><inertial><origin xyz="0 0 0.014"/><mass value="0.00004"/>
<inertia ixx="1e-10" iyy="1e-10" izz="1e-10" ixy="0" ixz="0" iyz="0"/></inertial>
<collision name="coil"><origin xyz="0 0 0.014"/><geometry><sphere radius="0.0012"/></geometry></collision></link>)" +
         jaw_urdf("left", -1) + jaw_urdf("right", 1) + R"(
<joint name="left_hinge" type="revolute"><parent link="body"/><child link="left"/><origin xyz="0 0 0.014"/><axis xyz="0 1 0"/>
<limit lower="0" upper="0.4" effort="1" velocity="1"/></joint>
<joint name="right_hinge" type="revolute"><parent link="body"/><child link="right"/><origin xyz="0 0 0.014"/><axis xyz="0 1 0"/>
<limit lower="-0.4" upper="0" effort="1" velocity="1"/><mimic joint="left_hinge" multiplier="-1"/></joint></robot>)";
}

inline std::string clip_json() {
  return R"({"unit": "mm", "clip": {"kind": "temporary", "shape": "straight", "blade_length_mm": 9, "blade_width_mm": 1.3,
"closing_force_N": 1.5, "force_slope_N_per_m": 300, "reference_mm": 9.5, "friction": 0.3, "blade_from": [0, 0, 9], "blade_to": [0, 0, 0],
"grip": {"position": [0, 0, 14], "shaft": [0, 0, 1], "flat": [1, 0, 0]}}})";
}

struct ClipBench {
  SceneFolder folder;
  std::unique_ptr<Simulation> s;
  Clip* clip = nullptr;
  ClipApplier* applier = nullptr;

  ClipBench() {
    folder.write("meshes/clip/clip.urdf", clip_urdf());
    folder.write("meshes/clip/tool.json", clip_json());
    folder.write("meshes/tool/tool.urdf", test_tool_urdf(0.0005));
  }
  /// A fixed plate, `thickness` across the blades, at z from low to high.
  std::string plate(double thickness, double low, double high) {
    folder.write("meshes/plate.obj",
                 obj_text(shapes::box(Vec3(-0.5 * thickness, -4e-3, low), Vec3(0.5 * thickness, 4e-3, high), 6)));
    return R"(<obstacle id="plate"><surface mesh="meshes/plate.obj" mesh_unit="m" material="bone"/></obstacle>)";
  }
  /// A fixed round bar along y, between the blades at z.
  std::string bar(double radius, double z) {
    constexpr int sides = 24, rings = 9;
    TriMesh m;
    for (int k = 0; k < rings; ++k)
      for (int i = 0; i < sides; ++i) {
        const double a = 2 * 3.14159265358979323846 * i / sides;
        m.vertices.push_back(Vec3(radius * std::cos(a), 1e-3 * (k - 4), z + radius * std::sin(a)));
      }
    for (int k = 0; k + 1 < rings; ++k)
      for (int i = 0; i < sides; ++i) {
        const int a = k * sides + i, b = k * sides + (i + 1) % sides;
        m.triangles.push_back({a, a + sides, b});
        m.triangles.push_back({b, a + sides, b + sides});
      }
    for (int i = 1; i + 1 < sides; ++i) {
      const int last = (rings - 1) * sides;
      m.triangles.push_back({0, i, i + 1});
      m.triangles.push_back({last, last + i + 1, last + i});
    }
    folder.write("meshes/bar.obj", obj_text(m));
    return R"(<obstacle id="plate"><surface mesh="meshes/bar.obj" mesh_unit="m" material="bone"/></obstacle>)";
  }
  /// A strip of tissue between the blades, fixed at its foot: 1.2 mm across, z from 1 to 5 mm.
  std::string strip(const std::string& young) {
    folder.write("meshes/strip.msh",
                 gmsh_text(block_mesh({2, 6, 4}, Vec3(-0.6e-3, -3e-3, 1e-3), Vec3(0.6e-3, 3e-3, 5e-3))));
    return R"(<soft_body id="plate" mesh="meshes/strip.msh" mesh_unit="m"><corotational_fem young=")" + young + R"("/>
<fixed region="beyond" centre="0 0 1.01 mm" normal="0 0 -1"/><surface/></soft_body>)";
  }
  static std::string clip_element(const std::string& attributes) {
    return R"(<clip id="clip" model="meshes/clip/clip.urdf" )" + attributes + "/>";
  }
  static std::string applier_element(const std::string& attributes) {
    return R"(<clip_applier id="applier" model="meshes/tool/tool.urdf" hand="right" clips="clip" home="0 0 14 mm" shaft="0 0 1" flat="1 0 0" )" +
           attributes + "/>";
  }
  bool load(const std::string& elements, const std::string& scene = "", int threads = 1) {
    s = load_text("<scene " + scene + R"(><solver max_sweeps="2000" tolerance="1e-13 m"/>)" + elements + "</scene>",
                  folder.path() / "scene.xml", threads);
    if (!s) return false;
    clip = s->scene().find_as<Clip>("clip");
    applier = s->scene().find_as<ClipApplier>("applier");
    return clip != nullptr;
  }
  void steps(int n) {
    for (int i = 0; i < n; ++i) s->step();
  }
  void hand(const Pose& device, bool button1 = false, bool button2 = false) {
    HandState state;
    state.present = true;
    state.device = device;
    state.button1 = button1;
    state.button2 = button2;
    s->set_hand(1, state);
  }
  void run(const Pose& device, int n, bool button1 = false, bool button2 = false) {
    for (int i = 0; i < n; ++i) {
      hand(device, button1, button2);
      s->step();
    }
  }
  /// Moments of the contacts on one jaw (side -1 or 1) about the hinge, N m; also their sum of forces, N.
  double moment(double side, double* force = nullptr) const {
    double m = 0, f = 0;
    const Vec3 hinge = clip->pose().apply(Vec3(0, 0, hinge_z));
    for (const ContactPoint& c : s->report().contacts) {
      if (c.a != clip || c.normal.x() * side <= 0.5) continue;
      const Vec3 push = c.normal_force * c.normal + c.tangent_force;
      m += -side * (c.position - hinge).cross(push).dot(clip->pose().q * Vec3::UnitY());
      f += c.normal_force;
    }
    if (force) *force = f;
    return m;
  }
};

}  // namespace insula::test
