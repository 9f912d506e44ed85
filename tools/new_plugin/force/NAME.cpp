// SPDX-License-Identifier: GPL-3.0-or-later
/*
# @name@

A spring along every edge of a soft body's tetrahedra, without force at the edge's length at rest L:

    E = k/2 (l - L)^2,   f = -k (l - L) n,   df/dx = -k [n n^T + (1 - L/l) (I - n n^T)]

For the step's tangent 1 - L/l is taken as zero where the edge is shorter than at rest: it is then positive
semidefinite.
*/
#include <algorithm>

#include "core/mechanics/soft_body.h"
#include "core/registry/registry.h"

namespace insula {
namespace {

class @Name@ final : public ForceModel {
 public:
  Param<Stiffness> stiffness{
      this, {.name = "stiffness", .fallback = "1 N/m", .min = "0 N/m", .max = "10 kN/m", .doc = "of each edge"}};

  // Once: the elements, from the body's rest shape.
  void attach(PrepareContext& context, DeformableBody& body) override {
    const auto* soft = dynamic_cast<const SoftBody*>(&body);
    if (!soft) return error(context, "needs tetrahedra: it belongs in a <soft_body>");
    std::vector<std::pair<int, int>> pairs;
    for (const auto& tet : soft->rest().tets)
      for (std::size_t i = 0; i < 4; ++i)
        for (std::size_t j = 0; j < i; ++j) pairs.push_back(std::minmax(tet[i], tet[j]));
    std::sort(pairs.begin(), pairs.end());
    pairs.erase(std::unique(pairs.begin(), pairs.end()), pairs.end());
    edges_.clear();
    for (const auto& [i, j] : pairs)
      edges_.push_back({i, j, (soft->rest().nodes[std::size_t(i)] - soft->rest().nodes[std::size_t(j)]).norm()});
  }

  // Once: which 3x3 blocks of the body's matrix it fills, and where they are.
  void couplings(std::vector<std::pair<int, int>>& pairs, Tangent) const override {
    for (const Edge& e : edges_) pairs.emplace_back(e.i, e.j);
  }
  void bind(const BlockMatrix& a, const std::vector<int>& free_of_node) override {
    for (Edge& e : edges_) {
      const int i = free_of_node[std::size_t(e.i)], j = free_of_node[std::size_t(e.j)];
      e.ii = i < 0 ? -1 : a.diagonal(i);
      e.jj = j < 0 ? -1 : a.diagonal(j);
      e.ij = i < 0 || j < 0 ? -1 : a.slot(std::max(i, j), std::min(i, j));
    }
  }

  // Every step: force (N), and stiffness (N/m) where a matrix is given.
  void linearise(const double* x, double* force, BlockMatrix* matrix, double, Tangent which) override {
    for (const Edge& e : edges_) {
      const Vec3 d = at(x, e.i) - at(x, e.j);
      const double l = d.norm();
      if (l < 1e-12) continue;
      const Vec3 n = d / l, f = stiffness() * (l - e.rest) * n;
      Eigen::Map<Vec3>(force + 3 * e.i) -= f;
      Eigen::Map<Vec3>(force + 3 * e.j) += f;
      if (!matrix) continue;
      const double across = which == Tangent::system ? std::max(0.0, 1 - e.rest / l) : 1 - e.rest / l;
      const Mat3 k = stiffness() * (n * n.transpose() + across * (Mat3::Identity() - n * n.transpose()));
      if (e.ii >= 0) Eigen::Map<Mat3>(matrix->block(e.ii)) += k;
      if (e.jj >= 0) Eigen::Map<Mat3>(matrix->block(e.jj)) += k;
      if (e.ij >= 0) Eigen::Map<Mat3>(matrix->block(e.ij)) -= k;  // symmetric: the same to either side of the diagonal
    }
  }
  double energy(const double* x) override {
    double sum = 0;
    for (const Edge& e : edges_) {
      const double stretch = (at(x, e.i) - at(x, e.j)).norm() - e.rest;
      sum += 0.5 * stiffness() * stretch * stretch;
    }
    return sum;
  }

 private:
  struct Edge {
    int i, j;
    double rest;                    // m
    int ii = -1, jj = -1, ij = -1;  // blocks of the matrix; -1: a node is held
  };
  static Eigen::Map<const Vec3> at(const double* x, int node) { return Eigen::Map<const Vec3>(x + 3 * node); }
  std::vector<Edge> edges_;
};

}  // namespace
}  // namespace insula

INSULA_PLUGIN(@name@) { registry.add<insula::@Name@>("@name@", insula::Kind::force_model, "@doc@"); }
