// SPDX-License-Identifier: GPL-3.0-or-later
// The shipped arteries: sound surfaces with the dimensions of their table, free of the lobes.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <fstream>
#include <map>
#include <nlohmann/json.hpp>
#include <numbers>
#include <set>

#include "core/model/geometry/box_tree.h"
#include "core/model/geometry/triangle_distance.h"
#include "core/model/wall_model.h"

namespace insula {
namespace {

const std::filesystem::path source = INSULA_SOURCE_DIR;
using Json = nlohmann::json;

const Vec3& corner(const TriMesh& m, std::size_t t, std::size_t k) {
  return m.vertices[std::size_t(m.triangles[t][k])];
}

BoxTree tree_of(const TriMesh& m, double margin) {
  std::vector<Box> boxes;
  for (std::size_t t = 0; t < m.triangles.size(); ++t) {
    Box b;
    for (std::size_t k = 0; k < 3; ++k) b.extend(corner(m, t, k));
    boxes.emplace_back(b.min() - Vec3::Constant(margin), b.max() + Vec3::Constant(margin));
  }
  return BoxTree(std::move(boxes));
}

bool segment_hits(const Vec3& p, const Vec3& q, const Vec3& a, const Vec3& b, const Vec3& c) {
  const auto side = [](const Vec3& o, const Vec3& x, const Vec3& y, const Vec3& z) {
    return (x - o).cross(y - o).dot(z - o);
  };
  if (side(a, b, c, p) * side(a, b, c, q) > 0) return false;
  const double u = side(p, q, a, b), v = side(p, q, b, c), w = side(p, q, c, a);
  return (u > 0 && v > 0 && w > 0) || (u < 0 && v < 0 && w < 0);
}

/// Edges of one surface that pass through triangles of another (or of itself, where they share no vertex).
int edges_through(const TriMesh& edges_of, const TriMesh& m, bool itself) {
  constexpr double reach = 1e-3;  // longer than any half edge of an artery
  const BoxTree tree = tree_of(m, reach);
  int hits = 0;
  for (const auto& t : edges_of.triangles)
    for (std::size_t k = 0; k < 3; ++k) {
      const int i = t[k], j = t[(k + 1) % 3];
      if (i > j) continue;
      const Vec3 &p = edges_of.vertices[std::size_t(i)], &q = edges_of.vertices[std::size_t(j)];
      EXPECT_LT((q - p).norm(), 2 * reach);
      tree.containing(0.5 * (p + q), [&](int other) {
        const auto& o = m.triangles[std::size_t(other)];
        const bool shared = itself && std::any_of(o.begin(), o.end(), [&](int v) { return v == i || v == j; });
        hits += !shared && segment_hits(p, q, corner(m, std::size_t(other), 0), corner(m, std::size_t(other), 1),
                                        corner(m, std::size_t(other), 2));
        return false;
      });
    }
  return hits;
}

double winding_number(const TriMesh& m, const Vec3& p) {  // van Oosterom and Strackee
  double sum = 0;
  for (std::size_t t = 0; t < m.triangles.size(); ++t) {
    const Vec3 a = corner(m, t, 0) - p, b = corner(m, t, 1) - p, c = corner(m, t, 2) - p;
    const double x = a.norm(), y = b.norm(), z = c.norm();
    sum += 2 * std::atan2(a.dot(b.cross(c)), x * y * z + a.dot(b) * z + b.dot(c) * x + c.dot(a) * y);
  }
  return sum / (4 * std::numbers::pi);
}

/// Equivalent diameter of the section through a point: of the loop nearest to it, walked from triangle to triangle.
double section(const TriMesh& m, const Vec3& point, const Vec3& n) {
  struct Piece {
    Vec3 in, out;
    std::pair<int, int> from, to;  // edges
  };
  std::map<std::pair<int, int>, Piece> from_edge;
  for (const auto& t : m.triangles) {
    Piece piece;
    int found = 0;
    for (std::size_t k = 0; k < 3; ++k) {
      const Vec3 &p = m.vertices[std::size_t(t[k])], &q = m.vertices[std::size_t(t[(k + 1) % 3])];
      const double a = (p - point).dot(n), b = (q - point).dot(n);
      if ((a > 0) == (b > 0)) continue;
      (a > 0 ? piece.in : piece.out) = p + a / (a - b) * (q - p) - point;
      (a > 0 ? piece.from : piece.to) = std::minmax(t[k], t[(k + 1) % 3]);
      ++found;
    }
    if (found == 2) from_edge[piece.from] = piece;
  }
  const Piece* start = nullptr;
  for (const auto& [edge, piece] : from_edge)
    if (!start || piece.in.squaredNorm() < start->in.squaredNorm()) start = &piece;
  if (!start) return 0;
  Vec3 twice = Vec3::Zero();
  const Piece* at = start;
  for (std::size_t i = 0; i <= from_edge.size(); ++i) {
    twice += at->in.cross(at->out);
    at = &from_edge.at(at->to);
    if (at == start) break;
  }
  return 2 * std::sqrt(0.5 * std::abs(twice.dot(n)) / std::numbers::pi);
}

class Artery : public testing::TestWithParam<const char*> {
 protected:
  void SetUp() override {
    vessel = read_wall(source / "meshes/arteries" / GetParam() / "vessel.json");
    std::ifstream in(source / "tools/artery/arteries.json");
    const Json all = Json::parse(in);
    for (const Json& c : all["cases"])
      if (c["name"] == GetParam()) table = c;
    ASSERT_FALSE(table.is_null());
  }
  std::vector<std::size_t> of_region(const char* name) const {
    std::vector<std::size_t> out;
    for (std::size_t v = 0; v < vessel.vertex_region.size(); ++v)
      if (vessel.vertex_region[v] == vessel.region(name)) out.push_back(v);
    return out;
  }
  WallModel vessel;  // read_wall has checked that it is closed and outward
  Json table;
};

TEST_P(Artery, IsOneBallLikeSurfaceOfGoodTriangles) {
  const TriMesh& m = vessel.wall;
  EXPECT_GE(m.vertices.size(), 1500u);
  EXPECT_LE(m.vertices.size(), 2500u);
  std::vector<std::vector<int>> at(m.vertices.size());
  double least = 180;
  for (std::size_t t = 0; t < m.triangles.size(); ++t)
    for (std::size_t k = 0; k < 3; ++k) {
      at[std::size_t(m.triangles[t][k])].push_back(m.triangles[t][(k + 1) % 3]);
      const Vec3 u = corner(m, t, (k + 1) % 3) - corner(m, t, k), w = corner(m, t, (k + 2) % 3) - corner(m, t, k);
      least = std::min(least, std::atan2(u.cross(w).norm(), u.dot(w)) * 180 / std::numbers::pi);
    }
  EXPECT_GE(least, 28);
  std::set<int> seen{0};
  for (std::vector<int> stack{0}; !stack.empty();) {
    const int v = stack.back();
    stack.pop_back();
    for (const int n : at[std::size_t(v)])
      if (seen.insert(n).second) stack.push_back(n);
  }
  EXPECT_EQ(seen.size(), m.vertices.size()) << "more than one piece";
  EXPECT_EQ(2 * m.vertices.size(), m.triangles.size() + 4) << "V - E + F = 2 with E = 3F/2";
  EXPECT_EQ(edges_through(m, m, true), 0) << "self-intersections";
}

TEST_P(Artery, RegionsAreWholeAndLargeEnough) {
  EXPECT_EQ(vessel.regions,
            (std::vector<std::string>{"parent", "superior", "inferior", "neck", "sac", "bleb", "ends"}));
  const std::map<const char*, std::size_t> least{{"parent", 250}, {"superior", 180}, {"inferior", 180}, {"neck", 60},
                                                 {"sac", 150},    {"bleb", 20},      {"ends", 40}};
  for (const auto& [name, count] : least) EXPECT_GE(of_region(name).size(), count) << name;
  // Ends are the vertices of caps, no more and no fewer.
  std::set<std::size_t> on_caps;
  for (const auto& cap : vessel.caps)
    for (const int t : cap.triangles)
      for (const int v : vessel.wall.triangles[std::size_t(t)]) on_caps.insert(std::size_t(v));
  const auto ends = of_region("ends");
  EXPECT_EQ(std::vector<std::size_t>(on_caps.begin(), on_caps.end()), ends);
  for (const std::size_t v : of_region("sac"))
    EXPECT_GT((vessel.wall.vertices[v] - vessel.neck_centre).dot(vessel.neck_normal), 0);
  for (const std::size_t v : of_region("bleb"))
    EXPECT_LT((vessel.wall.vertices[v] - vessel.bleb_centre).norm(), 1.4 * vessel.bleb_radius);
}

TEST_P(Artery, CapsAreFlatDiscsAtTheEndsOfCentrelines) {
  ASSERT_EQ(vessel.caps.size(), 3u);
  const std::map<std::string, std::string> line_of{
      {"inlet", "parent"}, {"superior_outlet", "superior"}, {"inferior_outlet", "inferior"}};
  for (const auto& cap : vessel.caps) {
    const auto line = std::find_if(vessel.centrelines.begin(), vessel.centrelines.end(),
                                   [&](const auto& c) { return c.name == line_of.at(cap.name); });
    ASSERT_NE(line, vessel.centrelines.end());
    const bool start = line->from == cap.name;
    EXPECT_EQ(start ? line->from : line->to, cap.name);
    const Vec3 end = start ? line->points.front() : line->points.back();
    const double r = start ? line->radius.front() : line->radius.back();
    Vec3 area = Vec3::Zero();
    for (const int t : cap.triangles)
      area += 0.5 * (corner(vessel.wall, std::size_t(t), 1) - corner(vessel.wall, std::size_t(t), 0))
                        .cross(corner(vessel.wall, std::size_t(t), 2) - corner(vessel.wall, std::size_t(t), 0));
    EXPECT_NEAR(area.norm(), std::numbers::pi * r * r, 0.1 * std::numbers::pi * r * r)
        << cap.name;  // a polygon of ten sides lacks 6.5 %
    for (const int t : cap.triangles)
      for (std::size_t k = 0; k < 3; ++k)
        EXPECT_NEAR((corner(vessel.wall, std::size_t(t), k) - end).dot(area.normalized()), 0, 1e-6);
  }
}

TEST_P(Artery, DimensionsAreThoseOfTheTable) {
  constexpr double mm = 1e-3, share = 0.05;
  const auto near = [](double measured, double wanted, const char* what) {
    EXPECT_NEAR(measured, wanted, share * wanted) << what;
  };
  const double neck = table["sac"]["neck"].get<double>() * mm, height = table["sac"]["dome_height"].get<double>() * mm;
  near(section(vessel.wall, vessel.neck_centre, vessel.neck_normal), neck, "neck");
  near(vessel.neck_diameter, neck, "neck as told");
  double top = 0;
  for (const std::size_t v : of_region("sac"))
    top = std::max(top, (vessel.wall.vertices[v] - vessel.neck_centre).dot(vessel.neck_normal));
  near(top, height, "dome height");
  near(vessel.dome_height, height, "dome height as told");
  for (const char* name : {"parent", "superior", "inferior"}) {
    const auto& line = *std::find_if(vessel.centrelines.begin(), vessel.centrelines.end(),
                                     [&](const auto& c) { return c.name == name; });
    const auto& d = table[name]["diameter"];
    const double n = double(line.points.size() - 1);
    for (const double at : {0.35, 0.5, 0.65}) {
      const auto k = std::size_t(std::lround(at * n));
      const double wanted = (d[0].get<double>() + (d[1].get<double>() - d[0].get<double>()) * double(k) / n) * mm;
      near(section(vessel.wall, line.points[k], (line.points[k + 1] - line.points[k - 1]).normalized()), wanted, name);
    }
  }
}

TEST_P(Artery, LiesFreeBetweenTheLobes) {
  for (const char* lobe : {"frontal", "temporal", "insula"}) {
    const TriMesh m = read_surface(source / "meshes/lobes" / (std::string(lobe) + "_surface.ply"), 1e-3);
    const BoxTree tree = tree_of(m, 0);
    double least = 1;
    for (const Vec3& p : vessel.wall.vertices)
      tree.nearest(p, [&](int t) {
        const auto i = std::size_t(t);
        const double d2 = (nearest_on_triangle(p, corner(m, i, 0), corner(m, i, 1), corner(m, i, 2)) - p).squaredNorm();
        least = std::min(least, d2);
        return d2;
      });
    EXPECT_GE(std::sqrt(least), 0.3e-3) << lobe;
    // Nothing passes through the lobe, so one vertex outside means all are.
    EXPECT_EQ(edges_through(vessel.wall, m, false), 0) << lobe;
    EXPECT_NEAR(winding_number(m, vessel.wall.vertices[0]), 0, 1e-6) << lobe;
  }
}

TEST_P(Artery, ThePictureIsTheWallFourTimesAsFine) {
  const TriMesh p = read_surface(source / "meshes/arteries" / GetParam() / "picture.ply", 1e-3);
  EXPECT_EQ(p.triangles.size(), 4 * vessel.wall.triangles.size());
  EXPECT_EQ(edges_through(p, p, true), 0);
  const BoxTree tree = tree_of(vessel.wall, 0);
  for (const Vec3& q : p.vertices) {
    double d2 = 1;
    tree.nearest(q, [&](int t) {
      const auto i = std::size_t(t);
      const double d =
          (nearest_on_triangle(q, corner(vessel.wall, i, 0), corner(vessel.wall, i, 1), corner(vessel.wall, i, 2)) - q)
              .squaredNorm();
      d2 = std::min(d2, d);
      return d;
    });
    EXPECT_LT(std::sqrt(d2), 0.15e-3);
  }
}

INSTANTIATE_TEST_SUITE_P(Shipped, Artery, testing::Values("narrow_neck", "anterior_superior", "wide_neck"),
                         [](const auto& test) { return std::string(test.param); });

}  // namespace
}  // namespace insula
