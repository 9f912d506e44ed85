// SPDX-License-Identifier: GPL-3.0-or-later
// Vertices of a surface that are embedded in the nodes of a deformable body, laid out to be placed in every step: one
// pass gives positions, expected displacements and how far each region went. The bits are those of Body::position() and
// Body::expected_displacement(). What bounds the pass is memory, so weights are such that single precision holds them.
#pragma once
#include <array>
#include <span>
#include <vector>

#include "core/collision/search/collision_mesh.h"
#include "core/mechanics/deformable_body.h"

namespace insula {

/// Weights of sum 1, each within 2 of 0, as multiples of 2^-22: as floats they are the same, and their sum stays 1 to
/// the last bit. A point 5 mm from its nodes moves by a nanometre at most.
std::array<double, 4> embedding_weights(const std::array<double, 4>& weight);

class BarycentricEmbedding {
 public:
  /// Those that `which` numbers, all of one body, their weights made by embedding_weights(); `mesh` knows their
  /// regions.
  void build(std::span<const MaterialPoint> points, std::span<const int> which, const CollisionMesh& mesh);
  /// `positions` holds those of the last call, from which motion.moved is measured. Writes the numbered vertices only.
  void place(const DeformableBody& body, Vec3* positions, Vec3* expected, RegionMotion& motion);

 private:
  using Pair = double __attribute__((vector_size(16)));
  struct EmbeddedVertex {
    std::array<float, 4> weight;
    std::array<int, 4> node;
    int vertex, region;
  };
  /// Position x y z, velocity x y z.
  struct Node {
    Pair xy, zx, yz;
  };
  template <int nodes>
  void place_on(double step, Vec3* positions, Vec3* expected, RegionMotion& motion) const;

  int max_nodes_ = 0;  ///< nodes that a vertex is embedded in
  std::vector<EmbeddedVertex> vertices_;
  std::vector<Vec3> offset_;  ///< from the weighted nodes; empty: none has any
  std::vector<Node> nodes_;
};

}  // namespace insula
