// SPDX-License-Identifier: GPL-3.0-or-later
// A deformable solid on a tetrahedral mesh.
#pragma once
#include "core/mechanics/deformable_body.h"
#include "core/model/mesh.h"

namespace insula {

class SoftBody final : public DeformableBody {
 public:
  Param<File> mesh{this, {.name = "mesh", .doc = "tetrahedral mesh: gmsh .msh, VTK .vtk or .vtu, Medit .mesh"}};
  Param<LengthUnit> mesh_unit{this, {.name = "mesh_unit", .doc = "unit of length of the mesh file"}};

  void prepare(PrepareContext& context) override;
  const std::vector<Vec3>& rest_nodes() const override { return rest_.nodes; }

  const TetMesh& rest() const { return rest_; }
  /// Sets the mesh in place of a file, before prepare(), for tests and generated bodies.
  void set_mesh(TetMesh m) {
    rest_ = std::move(m);
    given_ = true;
  }

 private:
  TetMesh rest_;
  bool given_ = false;
};

}  // namespace insula
