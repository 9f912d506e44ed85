// SPDX-License-Identifier: GPL-3.0-or-later
// A surface that moves with its body, for contact and for the picture: a fine triangle mesh embedded in tetrahedra,
// riding on a shell's wall, or rigid on an obstacle.
#pragma once
#include <array>
#include <memory>
#include <vector>

#include "core/collision/search/collision_mesh.h"
#include "core/mechanics/body.h"
#include "core/model/mesh.h"

namespace insula {

class BarycentricEmbedding;
class ShellBody;

class Surface : public Component {
 public:
  static constexpr std::string_view kind_name = "surface";

  /// `<surface mesh="..." mesh_unit="mm" material="cortex" contact="true"/>`; without a mesh: the boundary of the
  /// body's tetrahedra.
  Param<File> mesh{
      this, {.name = "mesh", .fallback = "", .doc = "surface file; none: the boundary of the body's tetrahedra"}};
  Param<LengthUnit> mesh_unit{this,
                              {.name = "mesh_unit", .fallback = "mm", .doc = "unit of length of the surface file"}};
  Param<MaterialName> material{this, {.name = "material", .fallback = "cortex", .doc = "look in the viewer"}};
  Param<Length> thickness{this,
                          {.name = "thickness",
                           .fallback = "0 mm",
                           .min = "0 mm",
                           .max = "10 mm",
                           .doc = "of the wall whose middle this surface is; contact keeps half of it away; 0: the "
                                  "surface itself is touched"}};
  Param<bool> contact{
      this, {.name = "contact", .fallback = "true", .doc = "whether things touch it; false: for the picture alone"}};

  Surface();
  ~Surface() override;
  void prepare(PrepareContext& context) override;

  Body& body() const { return *body_; }
  const TriMesh& rest() const { return rest_; }                         ///< rest shape, scene frame
  const std::vector<MaterialPoint>& points() const { return points_; }  ///< one a vertex
  const std::vector<Vec3>& positions() const {
    return positions_;
  }  ///< at the start of the step; look_ahead() and update() refresh
  const std::vector<Vec3>& expected_displacements() const { return expected_; }  ///< what collision looks ahead along
  const std::vector<std::array<int, 3>>& triangles() const { return rest_.triangles; }

  /// Recomputes positions() from the body's q.
  void update();
  /// After free motion: positions(), but of what is for the picture alone, and expected_displacements() and
  /// collision(), if anything looks for contacts.
  void update_collision();
  /// Called in connect() of what looks for contacts: from then on the step keeps collision() up to date.
  void will_collide();
  const CollisionMesh& collision() const { return *collision_; }
  /// The material point of a triangle at barycentric coordinates; up to twelve nodes, merged and sorted.
  /// Adds direction d of it to the open row of the body.
  void add_row(BodyRows& rows, int triangle, const Vec3& bary, const Vec3& d) const;

 private:
  bool attach_to_shell(const ShellBody& shell);
  Body* body_ = nullptr;
  std::unique_ptr<CollisionMesh> collision_;  ///< one for all that touches the surface
  TriMesh rest_;
  std::vector<MaterialPoint> points_;
  std::vector<int> moving_;                          ///< the vertices that the step places
  std::unique_ptr<BarycentricEmbedding> embedding_;  ///< those, on a deformable body
  RegionMotion motion_;
  std::vector<Vec3> positions_, expected_;
};

}  // namespace insula
