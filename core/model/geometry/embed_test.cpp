// SPDX-License-Identifier: GPL-3.0-or-later
// Boundary triangles and embedding.
#include <gtest/gtest.h>

#include <map>
#include <random>

#include "core/base/input_error.h"
#include "core/model/formats/mesh_files_for_test.h"
#include "core/model/geometry/box_tree.h"
#include "core/model/geometry/triangle_distance.h"

namespace insula {
namespace {

double uniform(std::mt19937& random, double low, double high) {
  return low + (high - low) * double(random()) / 4294967295.0;
}
Vec3 somewhere(std::mt19937& random, double low, double high) {
  const double x = uniform(random, low, high), y = uniform(random, low, high), z = uniform(random, low, high);
  return {x, y, z};
}

TEST(Boundary, IsClosedOutwardAndAroundTheVolume) {
  const TetMesh mesh = test_files::box_mesh();
  const auto triangles = boundary_triangles(mesh);
  ASSERT_EQ(triangles.size(), 6u * 4 * 2);
  std::map<std::pair<int, int>, int> edges;
  double surface6 = 0, volume6 = 0;
  for (const auto& t : triangles) {
    for (int k = 0; k < 3; ++k) ++edges[{t[k], t[(k + 1) % 3]}];
    surface6 += mesh.nodes[t[0]].cross(mesh.nodes[t[1]]).dot(mesh.nodes[t[2]]);
  }
  for (const auto& [edge, n] : edges) {
    EXPECT_EQ(n, 1);
    EXPECT_EQ(edges.count({edge.second, edge.first}), 1u);
  }
  for (const auto& t : mesh.tets)
    volume6 += (mesh.nodes[t[1]] - mesh.nodes[t[0]])
                   .cross(mesh.nodes[t[2]] - mesh.nodes[t[0]])
                   .dot(mesh.nodes[t[3]] - mesh.nodes[t[0]]);
  EXPECT_NEAR(surface6, volume6, 1e-12 * volume6);  // divergence theorem: only outward faces give it
}

TEST(Embed, ReproducesLinearFieldsInsideAndJustOutside) {
  const TetMesh mesh = test_files::box_mesh();
  std::mt19937 random(3);
  std::vector<Vec3> points = mesh.nodes;  // corners too
  for (int i = 0; i < 400; ++i)
    points.push_back(Vec3(uniform(random, 0.4, 2.1), uniform(random, -0.3, 1.4), uniform(random, 0.2, 2.5)));
  for (int i = 0; i < 100; ++i)
    points.push_back(Vec3(uniform(random, 0.5, 2), uniform(random, -0.5, -0.34), uniform(random, 0.2, 2.5)));
  const Embedding e = embed(mesh, points);
  Mat3 a;
  a << 1.5, -0.2, 0.7, 0.1, 0.9, -1.1, 2.0, 0.3, -0.4;
  const Vec3 b(3, -2, 1);
  ASSERT_EQ(e.nodes.size(), points.size());
  for (std::size_t i = 0; i < points.size(); ++i) {
    Vec3 value = Vec3::Zero();
    double sum = 0;
    for (int k = 0; k < 4; ++k) {
      value += e.weights[i][k] * (a * mesh.nodes[std::size_t(e.nodes[i][k])] + b);
      sum += e.weights[i][k];
    }
    EXPECT_NEAR(sum, 1, 1e-13);
    EXPECT_LT((value - (a * points[i] + b)).norm(), 1e-12) << i;
  }
  EXPECT_GT(e.outside_m, 0.1);
  EXPECT_LT(e.outside_m, 0.2);
}

TEST(Embed, InsidePointsHaveNoNegativeWeightsAndNoDistance) {
  const TetMesh mesh = test_files::box_mesh();
  std::mt19937 random(5);
  std::vector<Vec3> points;
  for (const auto& t : mesh.tets) {
    Vec3 p = Vec3::Zero();
    double sum = 0;
    std::array<double, 4> w;
    for (double& x : w) sum += x = uniform(random, 0.01, 1);
    for (int k = 0; k < 4; ++k) p += w[std::size_t(k)] / sum * mesh.nodes[std::size_t(t[std::size_t(k)])];
    points.push_back(p);
  }
  const Embedding e = embed(mesh, points);
  EXPECT_EQ(e.outside_m, 0);
  EXPECT_EQ(e.nodes, mesh.tets);  // each in its own tetrahedron
  for (const auto& w : e.weights)
    for (double x : w) EXPECT_GT(x, 0);
}

TEST(Embed, FarPointsKeepBoundedWeights) {
  const TetMesh mesh = test_files::box_mesh();
  std::mt19937 random(7);
  std::vector<Vec3> points{{1000, 0, 0}, {-3, -3, -3}};
  for (int i = 0; i < 200; ++i) points.push_back(somewhere(random, -6, 6));
  const Embedding e = embed(mesh, points);
  EXPECT_GT(e.outside_m, 990);
  for (const auto& w : e.weights) {
    double sum = 0;
    for (double x : w) {
      sum += x;
      EXPECT_GE(x, -1 - 1e-12);
      EXPECT_LE(x, 2 + 1e-12);
    }
    EXPECT_NEAR(sum, 1, 1e-12);
  }
}

TEST(Embed, OutsideDistanceIsExact) {
  TetMesh mesh;
  mesh.nodes = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
  mesh.tets = {{0, 1, 2, 3}};
  EXPECT_NEAR(embed(mesh, {{0.2, 0.2, -0.5}}).outside_m, 0.5, 1e-15);    // a face
  EXPECT_NEAR(embed(mesh, {{0.5, -0.3, -0.4}}).outside_m, 0.5, 1e-15);   // an edge
  EXPECT_NEAR(embed(mesh, {{1 + 0.3, 0, -0.4}}).outside_m, 0.5, 1e-15);  // a corner
  EXPECT_THROW(embed(mesh, {{0, 0, std::nan("")}}), InputError);
  EXPECT_THROW(embed(TetMesh{}, {{0, 0, 0}}), InputError);
}

TEST(BoxTree, FindsWhatASearchThroughAllFinds) {
  std::mt19937 random(11);
  std::vector<std::array<Vec3, 3>> triangles;
  std::vector<Box> boxes;
  for (int i = 0; i < 300; ++i) {
    const Vec3 c = somewhere(random, -5, 5);
    triangles.push_back({c, c + somewhere(random, -1, 1), c + somewhere(random, -1, 1)});
    Box box;
    for (const Vec3& v : triangles.back()) box.extend(v);
    boxes.push_back(box);
  }
  const BoxTree tree(boxes);
  const auto distance2 = [&](int i, const Vec3& p) {
    const auto& t = triangles[std::size_t(i)];
    return (nearest_on_triangle(p, t[0], t[1], t[2]) - p).squaredNorm();
  };
  for (int round = 0; round < 200; ++round) {
    const Vec3 p = somewhere(random, -7, 7);
    int best = 0;
    std::vector<int> holding, found;
    for (int i = 0; i < 300; ++i) {
      if (distance2(i, p) < distance2(best, p)) best = i;
      if (boxes[std::size_t(i)].contains(p)) holding.push_back(i);
    }
    EXPECT_EQ(tree.nearest(p, [&](int i) { return distance2(i, p); }), best);
    tree.containing(p, [&](int i) {
      found.push_back(i);
      return false;
    });
    std::sort(found.begin(), found.end());
    EXPECT_EQ(found, holding);
  }
  EXPECT_EQ(BoxTree({}).nearest(Vec3::Zero(), [](int) { return 0.0; }), -1);
}

TEST(NearestOnTriangle, BeatsEverySampledPoint) {
  std::mt19937 random(13);
  for (int round = 0; round < 200; ++round) {
    const Vec3 a = somewhere(random, -1, 1), b = somewhere(random, -1, 1), c = somewhere(random, -1, 1),
               p = somewhere(random, -2, 2);
    const double found = (nearest_on_triangle(p, a, b, c) - p).norm();
    double sampled = 1e9;
    for (int i = 0; i <= 40; ++i)
      for (int j = 0; i + j <= 40; ++j)
        sampled = std::min(sampled, (a + i / 40.0 * (b - a) + j / 40.0 * (c - a) - p).norm());
    EXPECT_LE(found, sampled + 1e-12);
    EXPECT_GT(found, sampled - 0.15);
  }
}

}  // namespace
}  // namespace insula
