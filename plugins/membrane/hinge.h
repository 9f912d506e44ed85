// SPDX-License-Identifier: GPL-3.0-or-later
// Two triangles that share an edge: the angle between them, its gradient and its second derivatives.
#pragma once
#include "core/base/math.h"

namespace insula {

/// The edge (node[0], node[1]) has the direction of the first triangle. The apex of the first triangle is node[2], that
/// of the second node[3].
struct WallHinge {
  int node[4];
  double least[2] = {
      0, 0};  ///< squared doubled areas below which a triangle counts as collapsed (its gradient is bounded), m4
};

/// Angle of the second triangle from the plane of the first, rad in (-pi, pi]. It is positive where the apexes rise
/// along the normals. Its gradient (12 values, 1/m) goes into `gradient` if that is not null. At the apexes the
/// gradient is |e| N / |N|^2 with N the doubled area vector. At the edge's ends it is such that rigid motion has no
/// effect.
double hinge_angle(const double* x, const WallHinge& hinge, double* gradient);

using Mat12 = Eigen::Matrix<double, 12, 12>;
/// Second derivatives of the angle, 1/m2, in the order of the nodes.
Mat12 hinge_hessian(const double* x, const WallHinge& hinge);

}  // namespace insula
