// SPDX-License-Identifier: GPL-3.0-or-later
// Tetrahedra of several parts beside each other: meshed one by one, grown to hold their fine shapes, pushed apart.
#pragma once

#include "mesh_data.h"
#include "meshing.h"
#include "part_fields.h"

namespace insula::mesh_tool {

// Edge lengths near a focus and far from it, mm.
struct Sizes {
  double near = 0, far = 0;
};

// Where sizes grow from the one to the other: along the distance D (mm) to the other parts (0 with a single part) or,
// when greater, to a ball. D below `range.near`: near; above `range.far`: far.
struct Focus {
  Sizes range{2, 20};
  Vec3 point{};
  double radius = -1;  // negative: no ball
};

// The size field of one part. `fields` must outlive it.
SizeField growing(const PartFields& fields, std::size_t part, Sizes size, const Focus& focus);

struct PartMeshes {
  std::vector<TetMesh> meshes;  // a part each
  std::vector<std::vector<Vec3>>
      shape;  // nodes of the working grid just inside each fine shape: what the tetrahedra are to hold
};

// `cell` and `error`: a part each. Throws std::runtime_error when a part has no closed shape.
PartMeshes mesh_parts(const PartFields& fields, const std::vector<SizeField>& cell, const std::vector<SizeField>& error,
                      double gap);

}  // namespace insula::mesh_tool
