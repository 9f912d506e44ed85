// SPDX-License-Identifier: GPL-3.0-or-later
// Its weight stretches the spring by m g / k; the stop carries what the spring does not.
#include <gtest/gtest.h>

#include "core/testing/block_mesh.h"
#include "core/testing/example.h"

namespace insula {
namespace {

struct Rest {
  double z = 0;         ///< of the origin, m
  double stop = 0;      ///< force of the stop, N
  double weight = 0;    ///< N
  double velocity = 0;  ///< m/s
};

/// Where the body comes to rest on a spring of 50 N/m.
Rest rest(const std::string& lowest) {
  test::SceneFolder folder;
  folder.write("meshes/weight.urdf", test::test_tool_urdf(0.001));
  folder.write("meshes/tool.json", test::test_tool_json(0, 0));
  auto s = test::load_text(R"(<scene gravity="0 0 -9.81 m/s2">
  <@name@ id="weight" model="meshes/weight.urdf" home="0 0 0 mm" spring="50 N/m" lowest=")" +
                               lowest + "\"/></scene>",
                           folder.path() / "scene.xml");
  if (!s) return {};
  for (int i = 0; i < 600; ++i) s->step();
  const auto& body = dynamic_cast<const RigidBody&>(*s->bodies().at(0));
  const double z = body.link_pose(0).p.z();
  s->step();
  return {z, s->problem().lambda.at(0), 9.81 * body.tool().mass, (body.link_pose(0).p.z() - z) / s->h()};
}

TEST(@Name@, HangsWhereTheSpringCarriesItsWeight) {
  const Rest r = rest("-1 m");
  EXPECT_GT(r.weight, 0);
  EXPECT_NEAR(r.z, -r.weight / 50, 1e-9);
  EXPECT_NEAR(r.velocity, 0, 1e-9);
  EXPECT_EQ(r.stop, 0);
}

TEST(@Name@, TheStopCarriesTheRest) {
  const Rest r = rest("-0.1 mm");
  EXPECT_NEAR(r.z, -1e-4, 1e-9);
  EXPECT_NEAR(r.stop, r.weight - 50 * 1e-4, 1e-7);
}

}  // namespace
}  // namespace insula
