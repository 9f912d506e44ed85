// SPDX-License-Identifier: GPL-3.0-or-later
// A surface that is asked how far points are from it, and a grid that answers the same faster. Millimetres.
#pragma once
#include <memory>
#include <vector>

#include "core/collision/search/collision_mesh.h"
#include "core/model/mesh.h"

namespace insula::case_builder {

struct Nearest {
  bool found = false;   ///< none within the limit: nothing else is set
  double distance = 0;  ///< negative behind the surface
  int triangle = -1;
  Vec3 bary = Vec3::Zero();
  Vec3 outward = Vec3::UnitZ();  ///< unit: direction in which the distance grows
};

class Solid {
 public:
  explicit Solid(TriMesh mesh);
  Nearest nearest(const Vec3& p, double limit) const;
  const TriMesh& mesh() const { return mesh_; }
  void move(std::vector<Vec3> vertices);

 private:
  TriMesh mesh_;  ///< mm
  std::vector<Vec3> metres_;
  std::unique_ptr<CollisionMesh> collision_;
};

/// Distances at the nodes of a box, linear in between; `limit` where nothing is nearer.
class DistanceGrid {
 public:
  DistanceGrid(const Solid& solid, const Vec3& low, const Vec3& high, double step, double limit);
  double at(const Vec3& p) const;

 private:
  Vec3 low_;
  double step_, limit_;
  int n_[3];
  std::vector<float> value_;
};

}  // namespace insula::case_builder
