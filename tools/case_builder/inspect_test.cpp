// SPDX-License-Identifier: GPL-3.0-or-later
// The first look at a file: sizes, openings and necks in the frame of the author's file, and a problem in words.
#include "tools/case_builder/inspect.h"

#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "core/base/input_error.h"
#include "core/testing/example.h"
#include "tools/case_builder/shapes_for_test.h"
#include "tools/case_builder/topology.h"

namespace insula::case_builder {
namespace {

constexpr double aside = 3;  // mm of the vessel along x, so that a mirrored frame is told from the author's

class Inspect : public testing::Test {
 protected:
  insula::test::SceneFolder folder;
  Progress quiet;
  Inspection look(TriMesh mesh, const Options& options = {}) {
    for (Vec3& p : mesh.vertices) p.x() += aside;
    folder.write("vessel.stl", test::stl_text(mesh));
    return inspect(folder.path() / "vessel.stl", options, quiet);
  }
  static Vec3 point(const Json& at) { return Vec3(at[0].get<double>(), at[1].get<double>(), at[2].get<double>()); }
};

TEST_F(Inspect, TellsSizeOpeningsAndTheNeck) {
  Options mirrored;
  mirrored.mirror = true;
  for (const Options& options : {Options(), mirrored}) {
    const Inspection found = look(test::open_tube(), options);
    EXPECT_EQ(found.facts["problem"], "");
    EXPECT_LT((point(found.facts["size_mm"]) - Vec3(16, 4.8, 7.4)).norm(), 0.3);
    ASSERT_EQ(found.facts["openings"].size(), 2u);
    double ends = 0;
    for (const Json& opening : found.facts["openings"]) {
      const Vec3 centre = point(opening["centre"]), outward = point(opening["normal"]);
      EXPECT_NEAR(centre.x(), aside + 8 * outward.x(), 0.1);
      ends += centre.x();
    }
    EXPECT_NEAR(ends, 2 * aside, 0.1);
    const Json& neck = found.facts["neck"];
    EXPECT_GT(neck["confidence"], 0.5);
    ASSERT_FALSE(neck["proposals"].empty());
    const Json& first = neck["proposals"][0];
    EXPECT_LT((point(first["centre"]) - Vec3(aside, 0, 1.5)).norm(), 0.6);
    EXPECT_GT(point(first["normal"]).z(), 0.97);
    EXPECT_EQ(artery::quality(found.surface).euler, 2);
    EXPECT_GT(signed_volume(found.surface), 0);
  }
}

TEST_F(Inspect, AVesselWithoutASacIsShownWithItsProblem) {
  TriMesh tube = artery::extract([](const Vec3& p) { return std::hypot(p.y(), p.z()) - 1.4; },
                                 Vec3(-9.03, -3.01, -2.02), Vec3(9.07, 3.05, 2.1), 0.35);
  const Inspection found = look(std::move(tube));
  EXPECT_TRUE(found.facts["neck"]["proposals"].empty());
  EXPECT_FALSE(found.facts["problem"].get<std::string>().empty());
  EXPECT_FALSE(found.surface.triangles.empty());
}

TEST_F(Inspect, WritesWhatAPageReads) {
  look(test::open_tube());
  run_inspect(folder.path() / "vessel.stl", folder.path(), {}, nullptr, quiet);
  EXPECT_EQ(read_json(folder.path() / "inspect.json")["openings"].size(), 2u);
  EXPECT_GT(read_ply(folder.path() / "surface.ply").triangles.size(), 500u);
}

TEST_F(Inspect, RefusesWhatIsNoVessel) {
  folder.write("vessel.stl", "solid nothing\nendsolid nothing\n");
  EXPECT_THROW(inspect(folder.path() / "vessel.stl", {}, quiet), InputError);
}

}  // namespace
}  // namespace insula::case_builder
