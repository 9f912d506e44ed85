// SPDX-License-Identifier: GPL-3.0-or-later
// Tools whose links turn about hinges, and clips: what is read, what is refused, and every shipped clip.
#include <gtest/gtest.h>

#include <cmath>
#include <fstream>
#include <sstream>

#include "core/base/input_error.h"
#include "core/testing/held.h"
#include "core/testing/temp_folder.h"
#include "plugins/clip/clip_data.h"

namespace insula {
namespace {

using test_files::TempFolder;

std::string link(const std::string& name, const std::string& mass, const std::string& at,
                 const std::string& more = "") {
  return "<link name='" + name + "'><inertial><origin xyz='" + at + "' rpy='0 0 0'/><mass value='" + mass +
         "'/><inertia ixx='2e-9' ixy='0' ixz='0' iyy='3e-9' iyz='0' izz='4e-9'/></inertial>"
         "<visual name='" +
         name +
         "'><geometry><sphere radius='0.001'/></geometry></visual>"
         "<collision name='" +
         name + "_piece'><origin xyz='" + at + "'/><geometry><sphere radius='0.001'/></geometry></collision>" + more +
         "</link>";
}

const std::string driver =
    "<joint name='opening' type='revolute'><parent link='body'/><child link='left'/><origin xyz='0 0.002 0.012' rpy='0 "
    "0 0'/>"
    "<axis xyz='0 2 0'/><limit lower='0' upper='0.3' effort='1' velocity='1'/></joint>";
const std::string mimic =
    "<joint name='a_mirrored' type='revolute'><parent link='body'/><child link='right'/><origin xyz='0 0.002 0.012' "
    "rpy='0 0 0'/>"
    "<axis xyz='0 1 0'/><limit lower='-0.3' upper='0' effort='1' velocity='1'/><mimic joint='opening' multiplier='-1' "
    "offset='0'/></joint>";
const std::string links = link("body", "0.0001", "0 0 0.013") + link("left", "0.00002", "-0.001 0 -0.008") +
                          link("right", "0.00002", "0.001 0 -0.008");

std::string robot(const std::string& content) {
  return "<?xml version='1.0'?><robot name='probe'>" + content + "</robot>";
}

const std::string clip_json = R"({"unit": "mm", "rounding_mm": {"left_piece": 0.25},
  "clip": {"kind": "permanent", "shape": "curved", "blade_length_mm": 8.24621125, "blade_width_mm": 1.2, "closing_force_N": 1.8,
           "force_slope_N_per_m": 300, "reference_mm": 8, "friction": 0.3, "blade_from": [0, 2, 8], "blade_to": [0, 0, 0],
           "blade_line": [[0, 2, 8], [0, 1, 4], [0, 0, 0]],
           "grip": {"position": [0, 2, 12], "shaft": [0, 0, 2], "flat": [1, 0, 1]},
           "fenestration": {"centre": [0, 2, 9], "axis": [0, 3, 0], "diameter_mm": 5}}})";

std::string replaced(std::string text, const std::string& from, const std::string& to) {
  const std::size_t at = text.find(from);
  EXPECT_NE(at, std::string::npos) << from;
  return at == std::string::npos ? text : text.replace(at, from.size(), to);
}

std::string error_of(const std::string& text, const std::string& json = "") {
  const TempFolder folder;
  if (!json.empty()) folder.write("tool.json", json);
  try {
    read_clip_data(read_tool(folder.write("probe.urdf", text)));
  } catch (const InputError& e) {
    return e.what();
  }
  return "";
}

void expect_error(const std::string& content, const std::string& part) {
  const std::string error = error_of(robot(content));
  EXPECT_NE(error.find(part), std::string::npos) << "expected: " << part << "\ngot: " << error;
}

ToolModel probe(const std::string& json = "") {
  const TempFolder folder;
  if (!json.empty()) folder.write("tool.json", json);
  return read_tool(folder.write("probe.urdf", robot(links + driver + mimic)));
}

TEST(ToolLinks, AreReadInTheToolFrame) {
  const ToolModel tool = probe();
  ASSERT_EQ(tool.hinges.size(), 2u);
  EXPECT_DOUBLE_EQ(tool.opening_min, 0);
  EXPECT_DOUBLE_EQ(tool.opening_max, 0.3);
  EXPECT_EQ(tool.hinges[0].axis,
            Vec3::UnitY());  // made a unit vector; link 1 is the driver's, whatever the names' order
  EXPECT_EQ(tool.hinges[0].multiplier, 1);
  EXPECT_EQ(tool.hinges[1].multiplier, -1);
  EXPECT_EQ(tool.hinges[1].origin, Vec3(0, 0.002, 0.012));
  ASSERT_EQ(tool.pieces.size(), 3u);
  for (int k = 0; k < 3; ++k) {
    EXPECT_EQ(tool.pieces[std::size_t(k)].link, k);
    EXPECT_EQ(tool.parts[std::size_t(k)].link, k);
  }
  EXPECT_EQ(tool.pieces[1].name, "left_piece");
  EXPECT_LT((tool.pieces[1].points[0] - Vec3(-0.001, 0.002, 0.004)).norm(), 1e-15);
  EXPECT_FALSE(read_clip_data(tool));
}

TEST(ToolLinks, MassCentreAndInertiaAreThoseOfAllLinks) {
  const ToolModel tool = probe();
  const double m[3] = {1e-4, 2e-5, 2e-5};
  const Vec3 c[3] = {{0, 0, 0.013}, {-0.001, 0.002, 0.004}, {0.001, 0.002, 0.004}};
  Vec3 centre = Vec3::Zero();
  for (int k = 0; k < 3; ++k) centre += m[k] * c[k] / 1.4e-4;
  Mat3 inertia = 3 * Vec3(2e-9, 3e-9, 4e-9).asDiagonal().toDenseMatrix();
  for (int k = 0; k < 3; ++k) inertia -= m[k] * skew(c[k] - centre) * skew(c[k] - centre);
  EXPECT_NEAR(tool.mass, 1.4e-4, 1e-18);
  EXPECT_LT((tool.centre_of_mass - centre).norm(), 1e-15);
  EXPECT_LT((tool.inertia - inertia).norm(), 1e-20);
}

TEST(ToolLinks, TurnAboutTheirHinges) {
  const ToolModel tool = probe();
  const double a = 0.2;
  const Vec3 tip(0, 0, 0);  // 12 mm before the hinge
  const Vec3 left = tool.link_pose(1, a).apply(tip), right = tool.link_pose(2, a).apply(tip);
  EXPECT_LT((left - Vec3(-0.012 * std::sin(a), 0, 0.012 * (1 - std::cos(a)))).norm(), 1e-15);
  EXPECT_LT((right - Vec3(0.012 * std::sin(a), 0, 0.012 * (1 - std::cos(a)))).norm(), 1e-15);
  EXPECT_EQ(tool.link_pose(0, a).apply(tip), tip);
  for (int k = 0; k < 3; ++k) EXPECT_LT((tool.link_pose(k, 0).apply(Vec3(1, 2, 3)) - Vec3(1, 2, 3)).norm(), 1e-15);
  EXPECT_LT((tool.link_pose(1, a).apply(tool.hinges[0].origin) - tool.hinges[0].origin).norm(), 1e-15);
}

TEST(ToolLinks, RefuseOtherTrees) {
  expect_error(links + driver + replaced(mimic, "parent link='body'", "parent link='left'"),
               "every joint of a tool hangs on its root \"body\"");
  for (const char* type : {"prismatic", "continuous", "fixed", "floating"})
    expect_error(links + driver + replaced(mimic, "type='revolute'", std::string("type='") + type + "'"),
                 "is not revolute");
  expect_error(links + driver + replaced(mimic, "<mimic joint='opening' multiplier='-1' offset='0'/>", ""),
               "are independent; one must <mimic> the other");
  expect_error(links + driver + replaced(mimic, "joint='opening'", "joint='a_mirrored'"),
               "which is no independent joint");
  expect_error(links + driver + replaced(mimic, "joint='opening'", "joint='none'"), "probe.urdf: ");
  expect_error(links + replaced(driver, "</joint>", "<mimic joint='a_mirrored'/></joint>") + mimic, "mimics");
  expect_error(links + driver, "probe.urdf: ");  // a link that hangs nowhere
  expect_error(link("body", "0.0001", "0 0 0") + link("left", "0.0001", "0 0 0") +
                   replaced(driver, "child link='left'", "child link='none'"),
               "probe.urdf: ");
}

TEST(ToolLinks, RefuseBadHinges) {
  expect_error(links + replaced(driver, "xyz='0 2 0'", "xyz='0 0 0'") + mimic, "its axis must be finite and not zero");
  expect_error(links + replaced(driver, "upper='0.3'", "upper='-0.1'") + mimic, "limits must be finite, in order");
  expect_error(links + replaced(driver, "upper='0.3'", "upper='4'") + mimic, "within half a turn");
  for (const char* bad : {"nan", "inf", "1e999", "wide"})
    expect_error(links + replaced(driver, "upper='0.3'", std::string("upper='") + bad + "'") + mimic, "probe.urdf: ");
  expect_error(links + replaced(driver, "<limit lower='0' upper='0.3' effort='1' velocity='1'/>", "") + mimic,
               "probe.urdf: ");
  expect_error(links + driver + replaced(mimic, "multiplier='-1'", "multiplier='0'"), "must be finite and not zero");
  expect_error(links + driver + replaced(mimic, "offset='0'", "offset='0.1'"), "offset of its <mimic> must be 0");
  expect_error(links + driver + replaced(mimic, "lower='-0.3'", "lower='-0.2'"),
               "narrower than those of the joint it mimics");
  expect_error(link("body", "0.0001", "0 0 0") + link("left", "-1", "0 0 0") + driver, "link \"left\": its mass");
  expect_error(link("body", "0.0001", "0 0 0") + "<link name='left'/>" + driver, "link \"left\" has no <inertial>");
}

TEST(Clip, IsReadWhole) {
  const ToolModel tool = probe(clip_json);
  const auto data = read_clip_data(tool);
  ASSERT_TRUE(data);
  const ClipData& c = *data;
  EXPECT_EQ(c.kind, "permanent");
  EXPECT_EQ(c.shape, "curved");
  EXPECT_NEAR(c.blade_length, 8.24621125e-3, 1e-15);
  EXPECT_NEAR(c.blade_width, 1.2e-3, 1e-15);
  EXPECT_EQ(c.closing_force, 1.8);
  EXPECT_EQ(c.force_slope, 300);
  EXPECT_NEAR(c.reference, 8e-3, 1e-15);
  EXPECT_EQ(c.friction, 0.3);
  ASSERT_EQ(c.blade_line.size(), 3u);
  EXPECT_EQ(c.blade_line[0], c.blade_from);
  EXPECT_LT((c.blade_from - Vec3(0, 0.002, 0.008)).norm(), 1e-15);
  EXPECT_EQ(c.blade_to, Vec3(0, 0, 0));
  EXPECT_LT((c.grip.p - Vec3(0, 0.002, 0.012)).norm(), 1e-15);
  EXPECT_LT((c.grip.q.toRotationMatrix() - Mat3::Identity()).norm(),
            1e-12);  // the flat direction is made square to the shaft
  ASSERT_TRUE(c.fenestration);
  EXPECT_NEAR(c.fenestration->radius, 2.5e-3, 1e-15);
  EXPECT_EQ(c.fenestration->axis, Vec3::UnitY());
  EXPECT_NEAR(tool.pieces[1].radius, 0.25e-3, 1e-15);
  EXPECT_NEAR(tool.pieces[2].radius, 1e-3, 1e-15);
}

TEST(Clip, SpringRisesWithTheOpeningAndFallsOffAlongTheBlade) {
  const ClipData c = *read_clip_data(probe(clip_json));
  EXPECT_DOUBLE_EQ(c.torque(0), 8e-3 * 1.8);
  EXPECT_DOUBLE_EQ(c.gap(0.2), 2 * 8e-3 * std::sin(0.2));
  EXPECT_DOUBLE_EQ(c.torque(0.2), 8e-3 * (1.8 + 300 * 2 * 8e-3 * std::sin(0.2)));
}

TEST(Clip, RefusesBadNumbers) {
  const auto expect = [](const std::string& from, const std::string& to, const std::string& part) {
    const std::string error = error_of(robot(links + driver + mimic), replaced(clip_json, from, to));
    EXPECT_NE(error.find("tool.json: "), std::string::npos) << from << " -> " << to << ": " << error;
    EXPECT_NE(error.find(part), std::string::npos) << "expected: " << part << "\ngot: " << error;
  };
  for (const char* key :
       {"blade_length_mm", "blade_width_mm", "closing_force_N", "force_slope_N_per_m", "reference_mm", "friction"}) {
    const std::string name = "\"" + std::string(key) + "\": ";
    expect(name, "\"x\": ", std::string("clip.") + key + " is missing");
    expect(name, name + "-1, \"x\": ", std::string("clip.") + key + " must be a number from");
    expect(name, name + "1e300, \"x\": ", std::string("clip.") + key + " must be a number from");
    expect(name, name + "\"1\", \"x\": ", std::string("clip.") + key + " must be a number from");
  }
  expect("\"permanent\"", "\"eternal\"", "clip.kind must be");
  expect("\"curved\"", "\"Curved one\"", "clip.shape must be a word");
  expect("\"curved\"", "7", "clip.shape must be a word");
  expect("\"blade_from\": [0, 2, 8]", "\"blade_from\": [0, 8]", "three numbers");
  expect("\"blade_from\": [0, 2, 8]", "\"x\": 0", "clip.blade_from is missing");
  expect("\"blade_to\": [0, 0, 0]", "\"blade_to\": [0, 0, 1]", "must run from blade_from to blade_to");
  expect("[[0, 2, 8], [0, 1, 4], [0, 0, 0]]", "[[0, 2, 8]]", "two or more points");
  expect("\"blade_length_mm\": 8.2", "\"blade_length_mm\": 9.2", "differs from the length of the clamping line");
  expect("\"reference_mm\": 8", "\"reference_mm\": 3", "distance from the hinge to a point of the blade");
  expect("\"shaft\": [0, 0, 2]", "\"shaft\": [0, 0, 0]", "must not be zero");
  expect("\"flat\": [1, 0, 1]", "\"flat\": [0, 0, 1]", "must not be parallel");
  expect("\"position\"", "\"place\"", "clip.grip.position is missing");
  expect("\"grip\": {\"position\": [0, 2, 12], \"shaft\": [0, 0, 2], \"flat\": [1, 0, 1]}", "\"grip\": 1",
         "clip.grip must be an object");
  expect("\"diameter_mm\": 5", "\"diameter_mm\": 0", "clip.fenestration.diameter_mm");
  expect("\"axis\": [0, 3, 0]", "\"axis\": [0, 0, 0]", "must not be zero");
  expect("\"left_piece\": 0.25", "\"none\": 0.25", "names the collision \"none\"");
  expect("\"left_piece\": 0.25", "\"left_piece\": -1", "must lie between");
}

TEST(Clip, NeedsTwoOppositeJaws) {
  const auto expect = [](const std::string& content, const std::string& part) {
    const std::string error = error_of(robot(content), replaced(clip_json, "\"left_piece\": 0.25", ""));
    EXPECT_NE(error.find(part), std::string::npos) << "expected: " << part << "\ngot: " << error;
  };
  const std::string jaws = "two jaws that turn about one axis";
  expect(link("body", "0.0001", "0 0 0"), jaws);
  expect(link("body", "0.0001", "0 0 0") + link("left", "0.0001", "0 0 0") + driver, jaws);
  expect(links + driver +
             replaced(replaced(mimic, "multiplier='-1'", "multiplier='1'"), "lower='-0.3' upper='0'",
                      "lower='0' upper='0.3'"),
         jaws);
  expect(links + driver + replaced(mimic, "0 0.002 0.012", "0 0.002 0.013"), jaws);
  expect(links + replaced(driver, "lower='0' upper='0.3'", "lower='-0.1' upper='0'") +
             replaced(mimic, "upper='0'", "upper='0.3'"),
         "open to a positive one");
}

/// Largest x (side +1) or -x (side -1) of the blades' pieces of a jaw when it is open by `opening`.
double reach(const ToolModel& tool, int link, double side, double opening) {
  double most = -1;
  for (const ConvexPiece& p : tool.pieces) {
    if (p.link != link || p.name.find("_blade_") == std::string::npos) continue;
    for (const Vec3& x : p.points) most = std::max(most, side * tool.link_pose(link, opening).apply(x).x() + p.radius);
  }
  return most;
}

TEST(Clip, EveryShippedClipClosesAndOpens) {
  const std::filesystem::path folder = std::filesystem::path(INSULA_SOURCE_DIR) / "meshes" / "clips";
  int count = 0;
  for (const auto& entry : std::filesystem::recursive_directory_iterator(folder)) {
    if (entry.path().extension() != ".urdf") continue;
    SCOPED_TRACE(entry.path().string());
    ++count;
    const ToolModel tool = read_tool(entry.path());
    EXPECT_GT(tool.mass, 2e-5);
    EXPECT_LT(tool.mass, 3e-4);
    ASSERT_EQ(tool.hinges.size(), 2u);
    ASSERT_EQ(tool.parts.size(), 3u);
    const auto data = read_clip_data(tool);
    ASSERT_TRUE(data);
    EXPECT_EQ(tool.opening_min, 0);
    EXPECT_EQ(data->blade_to, Vec3(0, 0, 0));
    EXPECT_TRUE(test::held("shipped clips press twice as hard open",
                           std::abs(data->torque(tool.opening_max) / data->torque(0) - 2), 1, 1e-3));
    if (data->shape == "side_curved") continue;
    EXPECT_NEAR(reach(tool, 1, 1, 0), -5e-6, 1e-6);  // the left jaw's face, 5 um before the middle
    EXPECT_NEAR(reach(tool, 2, -1, 0), -5e-6, 1e-6);
    for (const ConvexPiece& p : tool.pieces) {
      if (p.link == 0 || p.name.find("_blade_") == std::string::npos) continue;
      double inner = 1;
      for (const Vec3& x : p.points) inner = std::min(inner, std::abs(x.x()));
      EXPECT_NEAR(inner - p.radius, 5e-6, 1e-6) << p.name;  // each piece has a clamping face
    }
    const double apart = -reach(tool, 1, 1, tool.opening_max) - reach(tool, 2, -1, tool.opening_max);
    EXPECT_GT(apart, 0.5e-3);  // open at the root too
  }
  EXPECT_GE(count, 40);
}

}  // namespace
}  // namespace insula
