// SPDX-License-Identifier: GPL-3.0-or-later
#include "core/mechanics/barycentric_embedding.h"

#include <algorithm>
#include <bit>
#include <cmath>

namespace insula {

std::array<double, 4> embedding_weights(const std::array<double, 4>& weight) {
  constexpr double quantum = 1.0 / (1 << 22);
  std::array<double, 4> out;
  double left = 1;
  for (std::size_t k = 0; k < 4; ++k) left -= out[k] = quantum * std::round(weight[k] / quantum);
  *std::max_element(out.begin(), out.end()) += left;
  return out;
}

void BarycentricEmbedding::build(std::span<const MaterialPoint> points, std::span<const int> which,
                                 const CollisionMesh& mesh) {
  vertices_.clear();
  offset_.clear();
  max_nodes_ = 0;
  bool any_offset = false;
  for (int v : which) {
    const MaterialPoint& p = points[std::size_t(v)];
    EmbeddedVertex embedded{{}, p.node, v, std::countr_zero(mesh.region_of(v))};
    for (std::size_t k = 0; k < 4; ++k) {
      // Unused entries have weight zero, so any node serves.
      if (int(k) >= p.count) embedded.node[k] = p.node[0];
      else embedded.weight[k] = float(p.weight[k]);
    }
    vertices_.push_back(embedded);
    offset_.push_back(p.local);
    max_nodes_ = std::max(max_nodes_, p.count);
    any_offset = any_offset || !p.local.isZero(0);
  }
  if (!any_offset) offset_.clear();
}

void BarycentricEmbedding::place(const DeformableBody& body, Vec3* positions, Vec3* expected, RegionMotion& motion) {
  const double *q = body.q().data(), *v = body.v().data();
  nodes_.resize(std::size_t(body.nodes()));
  for (Node& n : nodes_) {
    n.xy = Pair{q[0], q[1]};
    n.zx = Pair{q[2], v[0]};
    n.yz = Pair{v[1], v[2]};
    q += 3;
    v += 3;
  }
  if (max_nodes_ <= 1) place_on<1>(body.step_length(), positions, expected, motion);
  else if (max_nodes_ == 2) place_on<2>(body.step_length(), positions, expected, motion);
  else if (max_nodes_ == 3) place_on<3>(body.step_length(), positions, expected, motion);
  else place_on<4>(body.step_length(), positions, expected, motion);
}

template <int nodes>
void BarycentricEmbedding::place_on(double step, Vec3* positions, Vec3* expected, RegionMotion& motion) const {
  std::array<Pair, CollisionMesh::regions> farthest2{};  // moved, displacement
  const bool offset = !offset_.empty();
  for (std::size_t i = 0; i < vertices_.size(); ++i) {
    const EmbeddedVertex& p = vertices_[i];
    Pair xy{}, zx{}, yz{};
    if (offset) {
      const Vec3& o = offset_[i];
      xy = Pair{o[0], o[1]};
      zx = Pair{o[2], 0};
    }
#pragma GCC unroll 4
    for (std::size_t k = 0; k < nodes; ++k) {
      const Node& n = nodes_[std::size_t(p.node[k])];
      const Pair w{double(p.weight[k]), double(p.weight[k])};
      xy += w * n.xy;
      zx += w * n.zx;
      yz += w * n.yz;
    }
    zx *= Pair{1, step};
    yz *= Pair{step, step};
    double* x = positions[p.vertex].data();
    double* swept = expected[p.vertex].data();
    const Pair a = xy - Pair{x[0], x[1]}, b = zx - Pair{x[2], 0}, a2 = a * a, b2 = b * b, c2 = yz * yz;
    const Pair sum = __builtin_shufflevector(a2, b2, 0, 3) +
                     (__builtin_shufflevector(a2, c2, 1, 2) + __builtin_shufflevector(b2, c2, 0, 3));
    Pair& farthest = farthest2[std::size_t(p.region)];
    farthest = farthest > sum ? farthest : sum;
    x[0] = xy[0], x[1] = xy[1], x[2] = zx[0];
    swept[0] = zx[1], swept[1] = yz[0], swept[2] = yz[1];
  }
  for (std::size_t r = 0; r < farthest2.size(); ++r) {
    motion.moved[r] = std::sqrt(farthest2[r][0]);
    motion.may_move[r] = std::sqrt(farthest2[r][1]);
  }
}

}  // namespace insula
