// SPDX-License-Identifier: GPL-3.0-or-later
// The slope of a wall across an edge, from the angles of the hinges about it.
//
// Morley's plate element needs the slope across the middle of each edge in addition to the corners. Here the slope is
// not an unknown. It is interpolated from the two triangles of the edge and their four neighbours, unfolded into one
// plane, and is exact for every quadratic deflection. It is taken relative to the plane of the edge's first triangle;
// the deflection at an apex counts as that apex rising. It is a sum over the edge's hinge and the four hinges about it,
//
//   sigma = sum rho_q phi_q,     and from the second triangle  sigma' = phi_edge - sigma.
//
// These are three equations for five weights. The solution is the one nearest to the two-triangle formula rho_edge = y1
// / (y1 + y2), with heights y.
#pragma once
#include "plugins/membrane/wall_topology.h"

namespace insula {

struct SlopeWeights {
  int count = 0;
  int hinge[5];
  double weight[5];  ///< of the angles, seen from the first triangle of the edge; hinge[0] is the edge's own
};

SlopeWeights slope_weights(const WallTopology& wall, const std::vector<Vec3>& rest, int hinge);

}  // namespace insula
