// SPDX-License-Identifier: GPL-3.0-or-later
// Tools from URDF: what is read, and what is refused.
#include <gtest/gtest.h>

#include <fstream>
#include <numbers>

#include "core/base/input_error.h"
#include "core/model/formats/mesh_files_for_test.h"
#include "core/model/tools/tool_model.h"

namespace insula {
namespace {

using test_files::TempFolder;

const std::string inertial =
    "<inertial><origin xyz='0.01 0 0.1' rpy='0 0 0'/><mass value='0.02'/>"
    "<inertia ixx='2e-5' ixy='0' ixz='0' iyy='3e-5' iyz='0' izz='4e-5'/></inertial>";
const std::string sphere = "<collision name='tip'><geometry><sphere radius='0.001'/></geometry></collision>";

std::string urdf(const std::string& content) {
  return "<?xml version='1.0'?><robot name='probe'><link name='tool'>" + content + "</link></robot>";
}

std::string surface(const char* name) {
  for (const auto& f : test_files::surface_formats())
    if (f.name == name) return f.bytes(test_files::small_surface());
  return "";
}

std::string tool_error(const TempFolder& folder, const std::string& text) {
  try {
    read_tool(folder.write("probe.urdf", text));
  } catch (const InputError& e) {
    return e.what();
  }
  return "";
}

void expect_error(const std::string& content, const std::string& part) {
  const TempFolder folder;
  const std::string error = tool_error(folder, urdf(content));
  EXPECT_NE(error.find(part), std::string::npos) << "expected: " << part << "\ngot: " << error;
}

std::string replaced(std::string text, const std::string& from, const std::string& to) {
  const std::size_t at = text.find(from);
  EXPECT_NE(at, std::string::npos) << from;
  return text.replace(at, from.size(), to);
}

TEST(Tool, IsReadWhole) {
  const TempFolder folder;
  folder.write("parts/s.stl", surface("stl_binary"));
  folder.write("tool.json", R"({"unit": "mm", "tip": {"kind": "suction", "inner_radius_mm": 0.7},
      "blade": {"edge": [[0, 1, 2], [0, 0, 0], [0, -1, 2]], "cuts": true, "width_mm": 2}})");
  const std::string text =
      urdf(inertial +
           "<visual name='shaft'><origin xyz='0 0 0.1' rpy='0 0 1.5707963267948966'/><geometry><mesh "
           "filename='parts/s.stl' scale='0.001 0.002 0.003'/></geometry>"
           "<material name='steel_dark'><color rgba='0.1 0.2 0.3 1'/></material></visual>"
           "<visual><geometry><sphere radius='0.002'/></geometry></visual>"
           "<collision name='tip'><origin xyz='0 0 0.002'/><geometry><sphere radius='0.001'/></geometry></collision>"
           "<collision name='shaft_1'><origin xyz='0 0 0.01' rpy='0 1.5707963267948966 0'/><geometry><cylinder "
           "radius='0.001' length='0.01'/></geometry></collision>"
           "<collision name='blade'><geometry><mesh filename='package://probe/parts/s.stl' scale='0.001 0.001 "
           "0.001'/></geometry></collision>"
           "<collision><geometry><box size='0.01 0.02 0.03'/></geometry></collision>");
  const ToolModel tool = read_tool(folder.write("probe.urdf", text));
  EXPECT_EQ(tool.name, "probe");
  EXPECT_EQ(tool.mass, 0.02);
  EXPECT_EQ(tool.centre_of_mass, Vec3(0.01, 0, 0.1));
  EXPECT_LT((tool.inertia - Vec3(2e-5, 3e-5, 4e-5).asDiagonal().toDenseMatrix()).norm(), 1e-18);
  EXPECT_DOUBLE_EQ(tool.tip_inner_radius, 0.7e-3);
  ASSERT_EQ(tool.blade_edges.size(), 2u);
  EXPECT_LT((tool.blade_edges[1][1] - Vec3(0, -1e-3, 2e-3)).norm(), 1e-15);

  ASSERT_EQ(tool.pieces.size(), 4u);
  EXPECT_EQ(tool.pieces[0].name, "tip");
  EXPECT_EQ(tool.pieces[0].radius, 0.001);
  ASSERT_EQ(tool.pieces[0].points.size(), 1u);
  EXPECT_EQ(tool.pieces[0].points[0], Vec3(0, 0, 0.002));
  ASSERT_EQ(tool.pieces[1].points.size(), 2u);  // a capsule of 10 mm in all, turned onto x
  EXPECT_LT((tool.pieces[1].points[0] - Vec3(-0.004, 0, 0.01)).norm(), 1e-12);
  EXPECT_LT((tool.pieces[1].points[1] - Vec3(0.004, 0, 0.01)).norm(), 1e-12);
  EXPECT_EQ(tool.pieces[2].points.size(), 4u);
  EXPECT_EQ(tool.pieces[2].radius, 0);
  EXPECT_EQ(tool.pieces[3].points.size(), 8u);

  ASSERT_EQ(tool.parts.size(), 2u);
  EXPECT_EQ(tool.parts[0].material, "steel_dark");
  EXPECT_NEAR(tool.parts[0].rgba[2], 0.3, 1e-6);
  Vec3 high = tool.parts[0].mesh.vertices[0];
  for (const Vec3& v : tool.parts[0].mesh.vertices) high = high.cwiseMax(v);
  EXPECT_LT((high - Vec3(0, 0.002, 0.112)).norm(),
            1e-9);  // scaled by axis, then turned by 90 degrees about z, then moved
}

TEST(Tool, InertiaIsTurnedIntoTheToolFrame) {
  const TempFolder folder;
  const ToolModel tool = read_tool(
      folder.write("probe.urdf", urdf(replaced(inertial, "rpy='0 0 0'", "rpy='0 0 1.5707963267948966'") + sphere)));
  EXPECT_LT((tool.inertia - Vec3(3e-5, 2e-5, 4e-5).asDiagonal().toDenseMatrix()).norm(), 1e-15);
  EXPECT_EQ(tool.blade_edges.size(), 0u);  // no tool.json
}

TEST(Tool, RefusesBadMasses) {
  for (const char* bad : {"0", "-1", "nan", "inf", "heavy", ""})
    expect_error(replaced(inertial, "mass value='0.02'", std::string("mass value='") + bad + "'") + sphere,
                 "probe.urdf: ");
  expect_error(sphere, "no <inertial>");
  expect_error(replaced(inertial, "<mass value='0.02'/>", "") + sphere, "valid URDF");
}

TEST(Tool, RefusesBadInertia) {
  expect_error(replaced(inertial, "ixx='2e-5'", "ixx='-2e-5'") + sphere, "not positive definite");
  expect_error(replaced(inertial, "ixy='0'", "ixy='3e-5'") + sphere, "not positive definite");
  expect_error(replaced(inertial, "izz='4e-5'", "izz='6e-5'") + sphere, "belongs to no body");
  expect_error(replaced(inertial, "izz='4e-5'", "izz='nan'") + sphere, "probe.urdf: ");
  expect_error(replaced(inertial, "izz='4e-5'", "") + sphere, "valid URDF");
}

TEST(Tool, RefusesBadPieces) {
  expect_error(inertial, "no collision pieces");
  expect_error(inertial + "<collision><geometry><sphere radius='-1'/></geometry></collision>", "positive and finite");
  expect_error(inertial + "<collision><geometry><cylinder radius='0.01' length='0.01'/></geometry></collision>",
               "use a sphere");
  expect_error(inertial + "<collision name='c'/>", "probe.urdf: ");
  expect_error(inertial + "<collision><geometry><mesh filename='none.obj'/></geometry></collision>",
               "none.obj: no such file");
  expect_error(inertial + "<collision><geometry><mesh filename='../none.obj'/></geometry></collision>",
               "outside this file's folder");
  expect_error(inertial + "<collision><geometry><mesh filename='/none.obj'/></geometry></collision>",
               "relative to this file");
  expect_error(inertial + "<collision><geometry><mesh filename='file:///none.obj'/></geometry></collision>",
               "relative to this file");
  expect_error(inertial + sphere +
                   "<visual><geometry><sphere radius='1'/></geometry><material name='m'><color rgba='2 0 0 "
                   "1'/></material></visual>",
               "color");
}

TEST(Tool, RefusesHullsOfTooManyPoints) {
  const TempFolder folder;
  std::string obj;
  for (int i = 0; i < 25; ++i) obj += "v " + std::to_string(i) + " " + std::to_string(i * i) + " 1\n";
  for (int i = 1; i < 24; ++i)
    obj += "f " + std::to_string(i) + " " + std::to_string(i + 1) + " " + std::to_string(i + 2) + "\n";
  folder.write("many.obj", obj);
  const std::string error =
      tool_error(folder, urdf(inertial + "<collision><geometry><mesh filename='many.obj'/></geometry></collision>"));
  EXPECT_NE(error.find("25 points; at most 24"), std::string::npos) << error;
}

TEST(Tool, RefusesTruncatedMeshes) {
  const TempFolder folder;
  folder.write("s.stl", surface("stl_binary").substr(0, 150));
  const std::string error =
      tool_error(folder, urdf(inertial + "<collision><geometry><mesh filename='s.stl'/></geometry></collision>"));
  EXPECT_NE(error.find("s.stl: ends early"), std::string::npos) << error;
}

TEST(Tool, RefusesSymbolicLinksOutOfItsFolder) {
  const TempFolder folder;
  folder.write("s.stl", surface("stl_binary"));
  folder.write("in/probe.urdf",
               urdf(inertial + "<collision><geometry><mesh filename='s.stl'/></geometry></collision>"));
  std::filesystem::create_symlink(folder.path() / "s.stl", folder.path() / "in" / "s.stl");
  EXPECT_THROW(read_tool(folder.path() / "in" / "probe.urdf"), InputError);
}

TEST(Tool, RefusesOtherXml) {
  const TempFolder folder;
  EXPECT_NE(tool_error(folder, "<robot name='a'><link"), "");
  EXPECT_NE(tool_error(folder, "no xml"), "");
  EXPECT_NE(tool_error(folder, "<scene/>"), "");
  EXPECT_NE(tool_error(folder, "<!DOCTYPE r [<!ENTITY a 'b'>]><robot name='&a;'/>"), "");
  EXPECT_NE(tool_error(folder, "<robot name='a'><link name='l'/><link name='m'/></robot>"), "");
  std::string deep;
  for (int i = 0; i < 100000; ++i) deep += "<a>";
  EXPECT_NE(tool_error(folder, deep), "");
  const std::string text = urdf(inertial + sphere);
  for (std::size_t n = 0; n < text.size(); ++n) EXPECT_NE(tool_error(folder, text.substr(0, n)), "") << n;
}

TEST(Tool, RefusesBadToolJson) {
  for (const char* bad :
       {"", "{", "[]", R"({"unit": "cm"})", R"({"tip": 3})", R"({"tip": {"inner_radius_mm": -1}})",
        R"({"blade": {"cuts": 1}})", R"({"tip": {"inner_radius_mm": "1"}})", R"({"blade": {}})",
        R"({"blade": {"edge": [[0,0,0]]}})", R"({"blade": {"edge": [[0,0,0],[0,0]]}})",
        R"({"blade": {"edge": [[0,0,0],[0,0,0]]}})", R"({"blade": {"edge": [[0,0,0],[0,0,1e999]]}})"}) {
    const TempFolder folder;
    folder.write("tool.json", bad);
    EXPECT_NE(tool_error(folder, urdf(inertial + sphere)).find("tool.json: "), std::string::npos) << bad;
  }
  const TempFolder folder;
  folder.write("tool.json", R"({"blade": {"edge": [[0,0,0],[0,0,5]], "cuts": false}})");
  EXPECT_TRUE(read_tool(folder.write("probe.urdf", urdf(inertial + sphere))).blade_edges.empty());
}

TEST(Tool, EveryShippedInstrumentIsRead) {
  const std::filesystem::path folder = std::filesystem::path(INSULA_SOURCE_DIR) / "meshes" / "instruments";
  if (!std::filesystem::exists(folder)) GTEST_SKIP() << "no instruments";
  for (const auto& entry : std::filesystem::recursive_directory_iterator(folder)) {
    if (entry.path().extension() != ".urdf") continue;
    SCOPED_TRACE(entry.path().string());
    const ToolModel tool = read_tool(entry.path());
    EXPECT_GT(tool.mass, 0.005);
    EXPECT_LT(tool.mass, 0.1);
    EXPECT_FALSE(tool.parts.empty());
    double nearest = 1;  // the origin is the working tip
    for (const auto& part : tool.parts)
      for (const Vec3& v : part.mesh.vertices) nearest = std::min(nearest, v.norm());
    EXPECT_LT(nearest, 0.002);
  }
}

}  // namespace
}  // namespace insula
