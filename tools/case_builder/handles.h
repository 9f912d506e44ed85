// SPDX-License-Identifier: GPL-3.0-or-later
// Vessels that touch grow together in a segmentation, which gives the surface a handle. A grid is parted there again.
#pragma once
#include "core/base/math.h"
#include "tools/mesh_lobes/grid_ops.h"

namespace insula::case_builder {

struct PartedHandles {
  int nodes = 0;              ///< that were taken from the inside
  Vec3 first = Vec3::Zero();  ///< one of them, mm
};

/// Makes the set of positive nodes a topological ball in the grid's Kuhn tetrahedra, whose border artery::extract()
/// takes. The set grows from its deepest node, deeper nodes first, by nodes that do not change its topology. Each loop
/// is so parted at its thinnest place. Nodes that are left out become negative. Source: topology-preserving region
/// growing, Mangin et al. 1995; a node is simple when its link's inner and outer part are connected.
PartedHandles part_handles(const mesh_tool::Grid& grid, mesh_tool::Field& inside);

}  // namespace insula::case_builder
