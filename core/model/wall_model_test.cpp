// SPDX-License-Identifier: GPL-3.0-or-later
// The vessel reader: a small good vessel, and everything that can be wrong with one.
#include <gtest/gtest.h>

#include <functional>
#include <nlohmann/json.hpp>

#include "core/base/input_error.h"
#include "core/model/formats/mesh_files_for_test.h"
#include "core/model/wall_model.h"

namespace insula {
namespace {

using Json = nlohmann::json;

// A tetrahedron with legs of 2 mm; one triangle is the cap.
const std::string header =
    "ply\nformat ascii 1.0\nelement vertex 4\nproperty float x\nproperty float y\nproperty float z\n"
    "element face 4\nproperty list uchar int vertex_indices\nend_header\n";
const std::string vertices = "0 0 0\n2 0 0\n0 2 0\n0 0 2\n";
const std::string faces = "3 0 2 1\n3 0 1 3\n3 0 3 2\n3 1 2 3\n";

Json good() {
  return Json::parse(R"({
    "unit": "mm", "regions": ["parent", "ends"], "vertex_region": [1, 0, 0, 1],
    "caps": [{"name": "inlet", "triangles": [2, 0]}],
    "centrelines": [{"name": "trunk", "region": "parent", "from": "inlet", "to": "dome", "points": [[0, 0, 0], [1, 2, 3]], "radius": [1, 0.5]}],
    "neck": {"centre": [1, 0, 0], "normal": [0, 0.6, 0.8], "diameter": 4}, "dome_height": 6,
    "bleb": {"centre": [0, 0, 5], "radius": 0.7}})");
}

WallModel read(const Json& json, const std::string& ply = header + vertices + faces) {
  const test_files::TempFolder folder;
  folder.write("wall.ply", ply);
  return read_wall(folder.write("vessel.json", json.dump()));
}

TEST(WallModel, EverythingIsReadInMetres) {
  const WallModel v = read(good());
  ASSERT_EQ(v.wall.vertices.size(), 4u);
  EXPECT_EQ(v.wall.vertices[2], Vec3(0, 2e-3, 0));
  ASSERT_EQ(v.wall.triangles.size(), 4u);
  EXPECT_EQ(v.wall.triangles[1], (std::array{0, 1, 3}));
  EXPECT_EQ(v.regions, (std::vector<std::string>{"parent", "ends"}));
  EXPECT_EQ(v.vertex_region, (std::vector<int>{1, 0, 0, 1}));
  EXPECT_EQ(v.region("ends"), 1);
  EXPECT_EQ(v.region("sac"), -1);
  ASSERT_EQ(v.caps.size(), 1u);
  EXPECT_EQ(v.caps[0].name, "inlet");
  EXPECT_EQ(v.caps[0].triangles, (std::vector<int>{0, 2}));
  ASSERT_EQ(v.centrelines.size(), 1u);
  const auto& c = v.centrelines[0];
  EXPECT_EQ(c.name + c.region + c.from + c.to, "trunkparentinletdome");
  ASSERT_EQ(c.points.size(), 2u);
  EXPECT_NEAR((c.points[1] - Vec3(1e-3, 2e-3, 3e-3)).norm(), 0, 1e-15);
  EXPECT_NEAR(c.radius[1], 0.5e-3, 1e-15);
  EXPECT_TRUE(v.has_neck);
  EXPECT_NEAR((v.neck_centre - Vec3(1e-3, 0, 0)).norm(), 0, 1e-15);
  EXPECT_NEAR((v.neck_normal - Vec3(0, 0.6, 0.8)).norm(), 0, 1e-12);
  EXPECT_NEAR(v.neck_diameter, 4e-3, 1e-15);
  EXPECT_NEAR(v.dome_height, 6e-3, 1e-15);
  EXPECT_NEAR(v.bleb_radius, 0.7e-3, 1e-15);
  EXPECT_NEAR(v.bleb_centre.z(), 5e-3, 1e-15);
}

TEST(WallModel, NeckAndBlebMayBeAbsent) {
  Json json = good();
  json.erase("neck"), json.erase("bleb"), json.erase("dome_height");
  const WallModel v = read(json);
  EXPECT_FALSE(v.has_neck);
  EXPECT_EQ(v.bleb_radius, 0);
}

TEST(WallModel, VerticesKeepTheirNumbers) {
  // The first triangle uses vertex 3 first; a reader that renumbers by use would show.
  const WallModel v = read(good(), header + "0 0 2\n0 0 0\n2 0 0\n0 2 0\n" + "3 3 2 1\n3 1 2 0\n3 1 0 3\n3 2 3 0\n");
  EXPECT_EQ(v.wall.vertices[0], Vec3(0, 0, 2e-3));
  EXPECT_EQ(v.wall.triangles[0], (std::array{3, 2, 1}));
}

struct Bad {
  const char* name;
  std::function<void(Json&)> spoil;
  const char* message;
};
class BadVessel : public testing::TestWithParam<Bad> {};

TEST_P(BadVessel, IsRefusedWithItsFileAndAReason) {
  Json json = good();
  GetParam().spoil(json);
  try {
    read(json);
    FAIL() << "was accepted";
  } catch (const InputError& e) {
    EXPECT_NE(std::string(e.what()).find("vessel.json: "), std::string::npos) << e.what();
    EXPECT_NE(std::string(e.what()).find(GetParam().message), std::string::npos) << e.what();
  }
}

INSTANTIATE_TEST_SUITE_P(
    Json, BadVessel,
    testing::Values(
        Bad{"list", [](Json& j) { j = Json::array(); }, "must hold one object"},
        Bad{"no_unit", [](Json& j) { j.erase("unit"); }, "unit must be \"mm\""},
        Bad{"inches", [](Json& j) { j["unit"] = "in"; }, "unit must be \"mm\""},
        Bad{"no_regions", [](Json& j) { j.erase("regions"); }, "regions is missing"},
        Bad{"regions_text", [](Json& j) { j["regions"] = "parent"; }, "regions must be a list"},
        Bad{"regions_empty", [](Json& j) { j["regions"] = Json::array(); }, "at least one region"},
        Bad{"region_number", [](Json& j) { j["regions"][0] = 3; }, "a region's name must be text"},
        Bad{"region_twice", [](Json& j) { j["regions"][1] = "parent"; }, "two regions are called \"parent\""},
        Bad{"too_few", [](Json& j) { j["vertex_region"].erase(0); },
            "vertex_region has 3 entries, and wall.ply 4 vertices"},
        Bad{"region_high", [](Json& j) { j["vertex_region"][2] = 2; },
            "vertex_region holds 2, which is not between 0 and 1"},
        Bad{"region_negative", [](Json& j) { j["vertex_region"][2] = -1; }, "holds -1"},
        Bad{"region_half", [](Json& j) { j["vertex_region"][2] = 0.5; }, "holds 0.5"},
        Bad{"region_huge", [](Json& j) { j["vertex_region"][2] = 18446744073709551615ull; },
            "holds 18446744073709551615"},
        Bad{"no_caps", [](Json& j) { j["caps"] = Json::array(); }, "at least one cap"},
        Bad{"cap_text", [](Json& j) { j["caps"][0] = "inlet"; }, "a cap's name is missing"},
        Bad{"cap_empty", [](Json& j) { j["caps"][0]["triangles"] = Json::array(); }, "cap \"inlet\" has no triangles"},
        Bad{"cap_high", [](Json& j) { j["caps"][0]["triangles"][0] = 4; },
            "cap \"inlet\" holds 4, which is not between 0 and 3"},
        Bad{"cap_twice",
            [](Json& j) {
              j["caps"].push_back({{"name", "inlet"}, {"triangles", {1}}});
            },
            "two caps are called \"inlet\""},
        Bad{"cap_shared",
            [](Json& j) {
              j["caps"].push_back({{"name", "outlet"}, {"triangles", {2}}});
            },
            "cap \"outlet\": triangle 2 is in a cap already"},
        Bad{"no_lines", [](Json& j) { j["centrelines"] = Json::array(); }, "at least one centreline"},
        Bad{"line_twice", [](Json& j) { j["centrelines"].push_back(j["centrelines"][0]); },
            "two centrelines are called \"trunk\""},
        Bad{"line_region", [](Json& j) { j["centrelines"][0]["region"] = "sac"; }, "there is no region \"sac\""},
        Bad{"line_from", [](Json& j) { j["centrelines"][0].erase("from"); }, "from is missing"},
        Bad{"line_point", [](Json& j) { j["centrelines"][0]["points"].erase(0); }, "points must be two or more"},
        Bad{"line_flat_point",
            [](Json& j) {
              j["centrelines"][0]["points"][0] = {1, 2};
            },
            "points must be three numbers"},
        Bad{"line_same",
            [](Json& j) {
              j["centrelines"][0]["points"][0] = {1, 2, 3};
            },
            "two points in a row are the same"},
        Bad{"line_null", [](Json& j) { j["centrelines"][0]["points"][0][0] = nullptr; }, "points must be a number"},
        Bad{"line_far", [](Json& j) { j["centrelines"][0]["points"][0][0] = 1e300; }, "points must be a number"},
        Bad{"line_radii", [](Json& j) { j["centrelines"][0]["radius"].erase(0); }, "has 2 points and 1 radii"},
        Bad{"line_radius", [](Json& j) { j["centrelines"][0]["radius"][0] = 0; }, "radius must be positive"},
        Bad{"neck_text", [](Json& j) { j["neck"] = "wide"; }, "neck.centre is missing"},
        Bad{"neck_normal",
            [](Json& j) {
              j["neck"]["normal"] = {0, 0, 2};
            },
            "neck.normal must have length 1"},
        Bad{"neck_diameter", [](Json& j) { j["neck"]["diameter"] = -1; }, "neck.diameter must be positive"},
        Bad{"no_dome", [](Json& j) { j.erase("dome_height"); }, "dome_height is missing"},
        Bad{"bleb", [](Json& j) { j["bleb"].erase("radius"); }, "bleb.radius is missing"}),
    [](const auto& test) { return std::string(test.param.name); });

struct BadWall {
  const char* name;
  std::string ply;
  const char* message;
};
class BadWallFile : public testing::TestWithParam<BadWall> {};

TEST_P(BadWallFile, IsRefusedWithItsFileAndAReason) {
  try {
    read(good(), GetParam().ply);
    FAIL() << "was accepted";
  } catch (const InputError& e) {
    EXPECT_NE(std::string(e.what()).find("wall.ply"), std::string::npos) << e.what();
    EXPECT_NE(std::string(e.what()).find(GetParam().message), std::string::npos) << e.what();
  }
}

std::string changed(std::string text, const std::string& from, const std::string& to) {
  return text.replace(text.find(from), from.size(), to);
}
const std::string whole = header + vertices + faces;

INSTANTIATE_TEST_SUITE_P(
    Ply, BadWallFile,
    testing::Values(BadWall{"empty", "", "ply"}, BadWall{"short", header + vertices, "ends early"},
                    BadWall{"nan", changed(whole, "0 2 0", "0 nan 0"), "not finite"},
                    BadWall{"far", changed(whole, "0 2 0", "0 2e9 0"), "too far away"},
                    BadWall{"index", changed(whole, "3 1 2 3", "3 1 2 4"), "names a vertex that does not exist"},
                    BadWall{"half", changed(whole, "3 1 2 3", "3 1 2 2.5"), "names a vertex that does not exist"},
                    BadWall{"quad", changed(whole, "3 1 2 3", "4 1 2 3 0"), "no triangle"},
                    BadWall{"open", changed(changed(whole, "3 1 2 3\n", ""), "face 4", "face 3"), "is not closed"},
                    BadWall{"turned", header + vertices + "3 0 1 2\n3 0 3 1\n3 0 2 3\n3 1 3 2\n", "inside out"},
                    BadWall{"one_turned", changed(whole, "3 1 2 3", "3 1 3 2"), "in the same direction"},
                    BadWall{"flat", changed(whole, "0 0 2", "1 0 0"), "is flat"},
                    BadWall{"unused", changed(changed(whole, "vertex 4", "vertex 5"), "0 0 2\n", "0 0 2\n5 5 5\n"),
                            "no triangle uses vertex 4"},
                    BadWall{"edges", changed(whole, "end_header", "element edge 0\nproperty int a\nend_header"),
                            "nothing else"}),
    [](const auto& test) { return std::string(test.param.name); });

TEST(WallModel, MissingFilesAndBrokenJsonAreNamed) {
  const test_files::TempFolder folder;
  EXPECT_THROW(read_wall(folder.path() / "vessel.json"), InputError);
  const auto file = folder.write("vessel.json", good().dump());
  EXPECT_THROW(read_wall(file), InputError);  // no wall
  folder.write("wall.ply", whole);
  EXPECT_NO_THROW(read_wall(file));
  folder.write("vessel.json", good().dump().substr(0, 100));
  EXPECT_THROW(read_wall(file), InputError);
}

}  // namespace
}  // namespace insula
