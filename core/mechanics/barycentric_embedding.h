// SPDX-License-Identifier: GPL-3.0-or-later
// Vertices of a surface that are embedded in the nodes of a deformable body. One pass in each step gives positions,
// expected displacements and the motion of each region. The bits are those of Body::position() and
// Body::expected_displacement(). Memory bandwidth bounds the pass, so the weights are exact in single precision.
#pragma once
#include <array>
#include <span>
#include <vector>

#include "core/collision/search/collision_mesh.h"
#include "core/mechanics/deformable_body.h"

namespace insula {

/// Rounds weights of sum 1, each within 2 of 0, to multiples of 2^-22. They are then exact as floats, and their sum is
/// exactly 1. A point 5 mm from its nodes moves by at most a nanometre.
std::array<double, 4> embedding_weights(const std::array<double, 4>& weight);

class BarycentricEmbedding {
 public:
  /// Embeds the points with the indices `which`, all of one body, whose weights come from embedding_weights(). `mesh`
  /// gives their regions.
  void build(std::span<const MaterialPoint> points, std::span<const int> which, const CollisionMesh& mesh);
  /// `positions` holds the result of the last call, from which motion.moved is measured. Writes only the chosen
  /// vertices.
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

  int max_nodes_ = 0;  ///< largest number of nodes that a vertex is embedded in
  std::vector<EmbeddedVertex> vertices_;
  std::vector<Vec3> offset_;  ///< from the weighted sum of nodes, m; empty: all are zero
  std::vector<Node> nodes_;
};

}  // namespace insula
