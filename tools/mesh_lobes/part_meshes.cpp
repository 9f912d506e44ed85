// SPDX-License-Identifier: GPL-3.0-or-later
#include "part_meshes.h"

#include <algorithm>

#include "separate.h"

namespace insula::mesh_tool {

SizeField growing(const PartFields& fields, std::size_t part, Sizes size, const Focus& focus) {
  return [&fields, part, size, focus](const Vec3& p) {
    double d = fields.fine.size() > 1 ? sample(fields.grid, fields.others[part], p) : 0;
    if (focus.radius >= 0) d = std::max(d, norm(p - focus.point) - focus.radius);
    double t = (d - focus.range.near) / (focus.range.far - focus.range.near);
    t = t < 0 ? 0 : t > 1 ? 1 : t;
    return size.near + t * (size.far - size.near);
  };
}

PartMeshes mesh_parts(const PartFields& fields, const std::vector<SizeField>& cell, const std::vector<SizeField>& error,
                      double gap) {
  PartMeshes out;
  for (std::size_t a = 0; a < cell.size(); ++a)
    out.meshes.push_back(mesh_volume(fields.grid, fields.coarse[a], cell[a], error[a]));
  out.shape.resize(out.meshes.size());
  const Grid& g = fields.grid;
  for (std::size_t a = 0; a < out.meshes.size(); ++a)
    for (int k = 0; k < g.size[2]; ++k)
      for (int j = 0; j < g.size[1]; ++j)
        for (int i = 0; i < g.size[0]; ++i)
          if (const float v = fields.fine[a][g.index(i, j, k)]; v > 0 && v < 0.5f)
            out.shape[a].push_back(g.point(i, j, k));
  for (int pass = 0; pass < 6; ++pass) {
    for (std::size_t a = 0; pass < 4 && a < out.meshes.size(); ++a) {
      reach_out(out.meshes[a], out.shape[a], 0.4, 4);
      improve_dihedral(out.meshes[a], 14, 0.3);
    }
    separate_parts(out.meshes, gap, 12);
    for (TetMesh& mesh : out.meshes) improve_dihedral(mesh, 12, 0.8);
  }
  return out;
}

}  // namespace insula::mesh_tool
