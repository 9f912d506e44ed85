// SPDX-License-Identifier: GPL-3.0-or-later
// Bending of a wall: Morley's plate element. Its slopes across edges are interpolated from the hinges' angles
// (slope.h).
//
//   curvature of a triangle  kappa = 1/A sum over its edges  l sigma nu nu^T,  nu the edge's in-plane normal at rest
//   energy                   A/2 (kappa - kappa0)^T D (kappa - kappa0),
//   D = E t^3 / (12 (1 - nu^2)) [1 nu 0; nu 1 0; 0 0 (1-nu)/2]  on (k11, k22, 2 k12)
//
// kappa is a constant linear map of at most nine angles, and the rest curvature is the same map at rest. The element is
// objective at any rotation. In the slaved Morley space only rigid functions bend without energy, and the interpolation
// is exact for quadratics. The element therefore converges on any mesh of well-shaped triangles. On a free rim the
// slope is an unknown of its one triangle and is eliminated there: no moment about the rim.
//
// The exact tangent couples the twelve nodes of a patch, which would fill the factor several times over. The step
// instead takes a stiffness of each hinge by itself, K~ = sum k_q grad(phi_q) grad(phi_q)^T with k_q = 0.6 sum_r |c_q .
// c_r|. By Gershgorin's theorem K~ >= 0.6 K. The linearly implicit step is therefore stable and tends to the same
// equilibrium.
#pragma once
#include <limits>
#include <utility>
#include <vector>

#include "core/mechanics/force_model.h"
#include "plugins/membrane/assemble.h"
#include "plugins/membrane/slope.h"
#include "plugins/membrane/stretch.h"
#include "plugins/membrane/wall_batch.h"

namespace insula {

class BendPatches {
 public:
  /// Patches of the wall's triangles for which material(t) is not null.
  void build(const WallTopology& wall, const std::vector<Vec3>& rest,
             const std::vector<const StretchTriangles::Material*>& material);
  void couplings(std::vector<std::pair<int, int>>& pairs, Tangent which, bool patches) const;
  void bind(const BlockMatrix& a, const std::vector<int>& free_of_node);
  void linearise(const double* x, double* force, BlockMatrix* stiffness, double scale, Tangent which, bool patches);
  double energy(const double* x);
  /// Changes the rest angles by those of the displacement u from rest. Both arguments have 3 values a node, m.
  void prestrain(const double* rest, const double* u);
  /// Resets the number of full turns of each hinge.
  void reset() { angle_ = start_angle_; }

 private:
  static constexpr int max_nodes = patch_nodes, max_hinges = 9;
  static constexpr int no_slot = std::numeric_limits<int>::min();
  struct Patch {
    int hinges = 0, nodes = 0;
    int hinge[max_hinges];
    unsigned char local[max_hinges][4];  // the hinge's nodes as indices of the patch's nodes
    double c[max_hinges][3];             // sqrt(A D) times the factor from the angle to the curvature
    int node[max_nodes];                 // in the order of the matrix once bound
    int first_slot = 0;                  // of its blocks (0,0) (1,0) (1,1) ...
  };
  class Maker;  // builds the patches
  void find_step_stiffness();
  void make_batches(const std::vector<Vec3>& rest);
  void residual(const Patch& p, const std::vector<double>& angle, double r[3]) const;
  void assemble(const Patch& p, double scale, BlockMatrix& stiffness);
  void add_hinges(BlockMatrix& stiffness, double scale) const;
  void add_curvature_of_hinges(const double* x, BlockMatrix& stiffness, double scale) const;

  void find_angles(const double* x, std::vector<double>& angle, double* gradient) const;

  std::vector<WallHinge> hinges_;
  std::vector<HingeBatch> batches_;     // of the hinges, in order
  std::vector<double> step_stiffness_;  // of each hinge, N m
  std::vector<double> start_angle_;     // in the rest configuration
  std::vector<double> rest_angle_;      // of the stress-free configuration, which differs with a prestrain
  std::vector<double> angle_, energy_angle_, moment_, gradient_;
  std::vector<std::array<int, 10>> hinge_slot_;  // lower triangle of the hinge's blocks; ~slot if stored transposed
  std::vector<Patch> patches_;
  std::vector<int> slots_;
  PatchRows rows_{};  // work of assemble()
};

}  // namespace insula
