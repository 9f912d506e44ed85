// SPDX-License-Identifier: GPL-3.0-or-later
// Stretch of a wall: linear plane-stress triangles, each in a frame that rotates with it.
//
//   F = sum x_i b_i^T (3 x 2) = R S,   e = S - I,   energy per area  t (mu |e|^2 + lambda/2 tr(e)^2)
//   mu = E / (2 (1 + nu)),   lambda = E nu / (1 - nu^2)   (plane stress)
//   G = 2 mu I + (lambda tr e - 2 mu) S^-1,   force on node i = -A t F G b_i
//
// Let g_i = R b_i, n the normal and p_i = n x g_i. Then the exact second derivative, divided by A t, is
//   mu (g_i.g_j) (I - n n^T) + mu g_j g_i^T + lambda g_i g_j^T      Hooke's law in the rotated frame
//   + (mu + lambda) tr e / (2 + tr e) p_i p_j^T                      spin in the plane
//   + (b_i^T G b_j) n n^T                                            tension against deflection
// The last two terms are the geometric stiffness. The step's tangent keeps their part under tension. Negative
// eigenvalues, which in-plane compression causes, are set to zero. The tangent is thus positive semidefinite and still
// stiff across a wall under tension.
//
// Prestrain e0 is symmetric, in the triangle's rest frame: e + e0 replaces e. Let Z = 2 mu e0 + lambda tr(e0) I = z I +
// D, with D free of trace. The prestrain adds Z : S to the energy. z adds to lambda tr e in G and to (mu + lambda) tr e
// in the spin. In the plane, D : S is h = D : C / tr S with C = F^T F. With y_i = F D b_i,
//   G += (2 D - h S^-1) / tr S
//   second derivative += 2/tr S (b_i^T D b_j) I - 2/(tr S)^2 (y_i g_j^T + g_i y_j^T - h g_i g_j^T + h/2 p_i p_j^T),
// and n n^T as above. Its in-plane part couples spin and shear, is indefinite and is small against Hooke's law. The
// step leaves it out.
#pragma once
#include <utility>
#include <vector>

#include "core/mechanics/force_model.h"
#include "plugins/membrane/wall_batch.h"

namespace insula {

class StretchTriangles {
 public:
  struct Material {
    double thickness, young, poisson;
  };
  void clear() { triangles_.clear(), batches_.clear(); }
  void add(const std::vector<Vec3>& rest, const std::array<int, 3>& nodes, const Material& material);
  void couplings(std::vector<std::pair<int, int>>& pairs) const;
  void bind(const BlockMatrix& a, const std::vector<int>& free_of_node);
  void linearise(const double* x, double* force, BlockMatrix* stiffness, double scale, Tangent which) const;
  double energy(const double* x) const;
  /// Adds the Cauchy stress of triangle i, which has this volume at rest (m3), to stress[of[i]], Pa.
  void add_stress(const double* x, const std::vector<int>& of, const std::vector<double>& volume,
                  std::vector<Mat3>& stress) const;
  /// Subtracts the linear strain of displacement u from the strain. Both arguments have 3 values a node, m.
  void prestrain(const double* rest, const double* u);

 private:
  struct Triangle {
    int node[3];        // in the order of the matrix once bound
    int slot[6];        // (0,0) (1,0) (1,1) (2,0) (2,1) (2,2); -1 if a node is fixed
    double b[3][2];     // rest gradients of the shape functions, 1/m
    double mu, lambda;  // times area and thickness, N m
    double pre[3];      // e0: 00, 01, 11
  };
  void pack();
  std::vector<Triangle> triangles_;
  std::vector<TriangleBatch> batches_;  // of the triangles, in order
};

}  // namespace insula
