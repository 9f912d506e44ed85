// SPDX-License-Identifier: GPL-3.0-or-later
// Lines of equal distance on a surface. From the tip of a vessel inward, their middles are its centreline (Verroust,
// Lazarus, "Extracting skeletal curves from 3D scattered data", The Visual Computer 16, 2000).
#pragma once
#include <vector>

#include "core/model/mesh.h"

namespace insula::case_builder {

/// The edges of a surface, with shortest distances along them. Refers to the mesh.
class Geodesics {
 public:
  explicit Geodesics(const TriMesh& mesh);
  const std::vector<int>& beside(int v) const { return beside_[std::size_t(v)]; }
  /// Of each vertex, in the unit of the mesh; infinite where no edges lead to.
  std::vector<double> from(int start) const;

 private:
  const TriMesh& m_;
  std::vector<std::vector<int>> beside_;
};

/// Of those that are reached.
int farthest_vertex(const std::vector<double>& distance);
int nearest_vertex(const TriMesh& mesh, const Vec3& point);
/// The root of an element of a union-find forest, whose paths are shortened.
int root_of(std::vector<int>& parent, int v);

/// A closed line on the surface.
struct Loop {
  Vec3 middle = Vec3::Zero();
  double length = 0, diameter = 0;  ///< mm; diameter of the circle of equal area
};
/// The loops on which a function of the vertices has a value.
std::vector<Loop> loops_at(const TriMesh& mesh, const std::vector<double>& function, double value);
/// The lines of equal distance from a tip, inward up to where the surface divides.
std::vector<Loop> lines_of_distance(const TriMesh& mesh, const std::vector<double>& distance);

}  // namespace insula::case_builder
