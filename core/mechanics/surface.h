// SPDX-License-Identifier: GPL-3.0-or-later
// A surface that moves with its body, for contact and for drawing: a fine triangle mesh embedded in tetrahedra,
// attached to a shell's wall, or fixed to an obstacle.
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
  const std::vector<MaterialPoint>& points() const { return points_; }  ///< one for each vertex
  const std::vector<Vec3>& positions() const {
    return positions_;
  }  ///< at the start of the step; update() and update_collision() refresh them
  const std::vector<Vec3>& expected_displacements() const {
    return expected_;
  }  ///< in the free motion, for collision detection, m
  const std::vector<std::array<int, 3>>& triangles() const { return rest_.triangles; }

  /// Recomputes positions() from the body's q.
  void update();
  /// Called after the free motion. Updates positions(), expected_displacements() and collision(), if the surface takes
  /// part in contact.
  void update_collision();
  /// Called in connect() by components that detect contacts. From then on the step keeps collision() up to date.
  void will_collide();
  const CollisionMesh& collision() const { return *collision_; }
  /// The material point of a triangle at barycentric coordinates depends on up to twelve nodes, merged and sorted.
  /// Adds direction d of this point to the open row of the body.
  void add_row(BodyRows& rows, int triangle, const Vec3& bary, const Vec3& d) const;

 private:
  bool attach_to_shell(const ShellBody& shell);
  Body* body_ = nullptr;
  std::unique_ptr<CollisionMesh> collision_;  ///< shared by all components that detect contacts with the surface
  TriMesh rest_;
  std::vector<MaterialPoint> points_;
  std::vector<int> moving_;                          ///< vertices that the step moves
  std::unique_ptr<BarycentricEmbedding> embedding_;  ///< of these vertices, on a deformable body
  RegionMotion motion_;
  std::vector<Vec3> positions_, expected_;
};

}  // namespace insula
