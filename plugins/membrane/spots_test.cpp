// SPDX-License-Identifier: GPL-3.0-or-later
// Parts of a wall about points: what they take from the membrane around them, and what is refused.
#include <gtest/gtest.h>

#include "plugins/membrane/shell_for_test.h"
#include "plugins/membrane/wall_topology.h"

namespace insula {
namespace {

using test::Cut;
using test::Wall;

WallTopology topology(const TriMesh& m) {
  WallTopology wall;
  EXPECT_EQ(wall.build(m.vertices, m.triangles), "");
  return wall;
}

double area(const TriMesh& m, const std::vector<char>& chosen) {
  double sum = 0;
  for (std::size_t t = 0; t < chosen.size(); ++t) {
    const auto at = [&](std::size_t k) { return m.vertices[std::size_t(m.triangles[t][k])]; };
    if (chosen[t]) sum += 0.5 * (at(1) - at(0)).cross(at(2) - at(0)).norm();
  }
  return sum;
}

TEST(WallSpots, ADiscHasTheAreaOfACircle) {
  const TriMesh plate = test::plate(0.02, 0.02, 80, 80, Cut::criss_cross);
  std::string wrong;
  const std::vector<char> disc = spot_triangles(topology(plate), plate.vertices, {Vec3(0.01, 0.01, 0)}, 5e-3, wrong);
  ASSERT_EQ(wrong, "");
  const double circle = std::numbers::pi * 25e-6;
  EXPECT_NEAR(area(plate, disc), circle, 0.01 * circle);
}

TEST(WallSpots, StayOnTheirSideOfAVessel) {
  const TriMesh tube = test::cylinder(1e-3, 0.02, 32, 80);
  std::string wrong;
  const WallTopology wall = topology(tube);
  const std::vector<char> small = spot_triangles(wall, tube.vertices, {Vec3(1e-3, 0, 0.01)}, 1e-3, wrong);
  ASSERT_EQ(wrong, "");
  for (std::size_t t = 0; t < small.size(); ++t) {
    const auto& v = tube.triangles[t];
    const Vec3 middle =
        (tube.vertices[std::size_t(v[0])] + tube.vertices[std::size_t(v[1])] + tube.vertices[std::size_t(v[2])]) / 3;
    EXPECT_EQ(bool(small[t]), (middle - Vec3(1e-3, 0, 0.01)).norm() <= 1e-3) << t;
  }
  // Two plates 0.4 mm apart: the ball holds parts of both, the spot is of the first.
  TriMesh two = test::plate(0.01, 0.01, 20, 20, Cut::one_way);
  const int first = int(two.triangles.size()), nodes = int(two.vertices.size());
  for (int v = 0; v < nodes; ++v) two.vertices.push_back(two.vertices[std::size_t(v)] + Vec3(0, 0, 4e-4));
  for (int t = 0; t < first; ++t) {
    const auto v = two.triangles[std::size_t(t)];
    two.triangles.push_back({v[0] + nodes, v[1] + nodes, v[2] + nodes});
  }
  const std::vector<char> one = spot_triangles(topology(two), two.vertices, {Vec3(5e-3, 5e-3, 0)}, 2e-3, wrong);
  for (int t = 0; t < first; ++t) EXPECT_EQ(one[std::size_t(t + first)], 0) << t;
  EXPECT_GT(area(two, one), 0.8 * std::numbers::pi * 4e-6);
}

TEST(WallSpots, AreReadWithTheirUnits) {
  std::string wrong;
  const std::vector<Vec3> two = read_spots("1 2 3 mm; 0.1 0 -1 cm", wrong);
  EXPECT_EQ(wrong, "");
  ASSERT_EQ(two.size(), 2u);
  EXPECT_LT((two[0] - Vec3(1e-3, 2e-3, 3e-3)).norm(), 1e-15);
  EXPECT_LT((two[1] - Vec3(1e-3, 0, -1e-2)).norm(), 1e-15);
  for (const char* text : {"1 2 3", "1 2 mm", "1 2 3 mm;", "1 2 3 mm, 4 5 6 mm", "1 2 3 kPa"}) {
    read_spots(text, wrong);
    EXPECT_NE(wrong, "") << text;
  }
}

double mass_of(const std::vector<Wall>& walls) {
  ShellBody body;
  body.set_mesh(test::plate(0.02, 0.02, 20, 20, Cut::criss_cross));
  for (const Wall& w : walls) test::add_membrane(body, w);
  EXPECT_EQ(test::finish(body), "");
  double mass = 0;
  for (const double m : body.node_mass()) mass += m;
  return mass;
}

TEST(WallSpots, LieInPlaceOfTheWallAroundThem) {
  const TriMesh plate = test::plate(0.02, 0.02, 20, 20, Cut::criss_cross);
  const WallTopology wall = topology(plate);
  std::string wrong;
  const auto at = [&](double x) {
    return area(plate, spot_triangles(wall, plate.vertices, {Vec3(x, 0.01, 0)}, 4e-3, wrong));
  };
  const double whole = 4e-4, left = at(8e-3), right = at(12e-3);
  const double both =
      area(plate, spot_triangles(wall, plate.vertices, {Vec3(8e-3, 0.01, 0), Vec3(12e-3, 0.01, 0)}, 4e-3, wrong));
  ASSERT_LT(both, left + right - 1e-6) << "they overlap";
  const Wall around{.thickness = 1e-3, .density = 1000};
  Wall first{.thickness = 3e-3, .density = 1000, .spots = "8 10 0 mm", .spot_radius = 4e-3}, second = first;
  second.thickness = 5e-3, second.spots = "12 10 0 mm";
  // The later one lies over the earlier one, wherever the wall around them stands in the file.
  const double expected = 1000 * (1e-3 * (whole - both) + 3e-3 * (both - right) + 5e-3 * right);
  EXPECT_NEAR(mass_of({around, first, second}), expected, 1e-12);
  EXPECT_NEAR(mass_of({first, second, around}), expected, 1e-12);
}

/// A strip that is pulled: the part that spots have made stiffer stretches by its own modulus.
TEST(WallSpots, StretchByTheirOwnModulus) {
  ShellBody body;
  body.set_mesh(test::plate(0.04, 0.01, 16, 4, Cut::criss_cross));
  const Wall soft{.thickness = 1e-3, .young = 1e6, .poisson = 0};
  Wall stiff = soft;
  stiff.young = 8e6, stiff.spots = "31 5 0 mm", stiff.spot_radius = 11e-3;
  test::add_membrane(body, soft);
  test::add_membrane(body, stiff);
  ASSERT_EQ(test::finish(body, [](const Vec3& x) { return x.x() < 1e-9; }), "");
  const double force = 1e-3;
  for (int i = 0; i < body.nodes(); ++i) {
    const Vec3& x = body.rest_nodes()[std::size_t(i)];
    if (x.x() > 0.04 - 1e-9) body.external[3 * i] = force * (x.y() < 1e-9 || x.y() > 0.01 - 1e-9 ? 0.125 : 0.25);
  }
  test::settle(body, 40);
  const auto mean = [&](double at) {
    double sum = 0;
    int n = 0;
    for (int i = 0; i < body.nodes(); ++i)
      if (std::abs(body.rest_nodes()[std::size_t(i)].x() - at) < 1e-9) sum += body.q()[3 * i] - at, ++n;
    return sum / n;
  };
  EXPECT_NEAR((mean(0.01) - mean(0)) / 0.01, force / (1e6 * 1e-3 * 0.01), 2e-3 * 1e-4);
  EXPECT_NEAR((mean(0.04) - mean(0.035)) / 0.005, force / (8e6 * 1e-3 * 0.01), 2e-2 * 1.25e-5);
}

std::string refused(const Wall& spot) {
  ShellBody body;
  body.set_mesh(test::plate(0.02, 0.02, 4, 4, Cut::one_way));
  test::add_membrane(body, {});
  test::add_membrane(body, spot);
  return test::finish(body);
}

TEST(WallSpots, WrongOnesAreRefusedInWords) {
  EXPECT_EQ(refused({.spots = "10 10 0 mm"}), "");
  EXPECT_NE(refused({.spots = "10 10 3 mm"}).find("spots: point 1 is 3.00 mm from the wall"), std::string::npos)
      << refused({.spots = "10 10 3 mm"});
  EXPECT_NE(refused({.spots = "10 10 0"}).find("spots: "), std::string::npos) << refused({.spots = "10 10 0"});
  EXPECT_NE(refused({.regions = "sac", .spots = "10 10 0 mm"}).find("\"sac\" is no region of the wall"),
            std::string::npos);
  ShellBody alone;
  alone.set_mesh(test::plate(0.02, 0.02, 4, 4, Cut::one_way));
  test::add_membrane(alone, {.spots = "10 10 0 mm"});
  EXPECT_NE(test::finish(alone).find("no membrane of this shell is the wall of wall"), std::string::npos);
}

}  // namespace
}  // namespace insula
