// SPDX-License-Identifier: GPL-3.0-or-later
// Geometry for strands: vertices within reach, paths along a surface, and normals.
#pragma once
#include <vector>

#include "core/model/mesh.h"

namespace insula {

/// Vertices sorted into cubes, for reproducible neighbour queries (ascending index).
class NearestVertices {
 public:
  NearestVertices(const std::vector<Vec3>& vertices, double cell);
  /// Indices of the vertices within r of p, ascending. r must be at most the cell size.
  void within(const Vec3& p, double r, std::vector<int>& out) const;

 private:
  const std::vector<Vec3>& vertices_;
  double cell_;
  Vec3 low_ = Vec3::Zero();
  int n_[3] = {0, 0, 0};
  std::vector<int> start_, index_;
};

/// Lengths of paths along the edges of a triangle mesh.
class SurfacePaths {
 public:
  explicit SurfacePaths(const TriMesh& mesh);
  /// Whether there is a path of at most `limit`, m, from a to b. The paths of the last a are kept.
  bool connected(int a, int b, double limit);

 private:
  void walk(int a, double limit);
  const TriMesh& mesh_;
  std::vector<int> start_, neighbour_;
  std::vector<double> length_;  ///< from `at_`, infinite if farther than `limit_`
  std::vector<int> touched_;
  int at_ = -1;
  double limit_ = 0;
};

/// Area-weighted unit normals.
std::vector<Vec3> vertex_normals(const TriMesh& mesh);

}  // namespace insula
