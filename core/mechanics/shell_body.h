// SPDX-License-Identifier: GPL-3.0-or-later
// A thin-walled body on a triangle surface: an artery, a strip. The triangles are the wall's middle surface. Its force
// models give the wall's material. Caps close it for volume and contact but are not part of the wall: they have no
// elements, and their nodes and rims are fixed.
#pragma once
#include <string>
#include <string_view>
#include <vector>

#include "core/mechanics/deformable_body.h"
#include "core/model/wall_model.h"

namespace insula {

class ShellBody final : public DeformableBody {
 public:
  static constexpr std::string_view kind_name = "shell_body";  ///< in messages about references to one

  Param<File> wall{this,
                   {.name = "wall",
                    .fallback = "",
                    .doc = "JSON file: wall surface with its regions, caps and centrelines",
                    .formerly = "vessel"}};
  Param<File> mesh{this, {.name = "mesh", .fallback = "", .doc = "plain surface file instead of that"}};
  Param<LengthUnit> mesh_unit{this,
                              {.name = "mesh_unit", .fallback = "mm", .doc = "unit of length of the surface file"}};

  void prepare(PrepareContext& context) override;
  const std::vector<Vec3>& rest_nodes() const override { return model_.wall.vertices; }
  void fix_own_nodes(std::vector<char>& fixed) const override;

  /// The wall as read. A plain surface has no caps, no centrelines and one region, "wall".
  const WallModel& model() const { return model_; }
  const TriMesh& rest() const { return model_.wall; }  ///< caps included
  /// Triangles of the wall without caps, in the order of rest().triangles.
  const std::vector<std::array<int, 3>>& wall_triangles() const { return wall_; }
  /// Index of a region by name, -1 when there is none.
  int region(std::string_view name) const;
  /// The region of a wall triangle: that of most of its vertices, or the lowest index on a tie.
  int region_of_triangle(const std::array<int, 3>& t) const;
  /// Sets the mesh in place of a file, before prepare(), for tests and generated bodies.
  void set_mesh(TriMesh m);
  void set_model(WallModel m);

 private:
  void finish_model();
  WallModel model_;
  std::vector<std::array<int, 3>> wall_;
  bool given_ = false;
};

}  // namespace insula
