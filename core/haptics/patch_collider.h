// SPDX-License-Identifier: GPL-3.0-or-later
// A tool against a patch of a surface, at one moment. It finds contacts with the code that the step uses
// (ToolCollider), without motion ahead, and chooses few of them (ContactSelection).
//
// The patch ends where the surface goes on. A piece that slid beyond such an open edge keeps one contact with the plane
// of the triangle at the edge, as long as it is not farther beside the edge than `farthest_beside_m`.
#pragma once
#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "core/collision/colliders/contact_selection.h"
#include "core/collision/colliders/tool_collider.h"
#include "core/constraint/surface_patch.h"

namespace insula {

/// Allocates only in its constructor.
class PatchCollider {
 public:
  PatchCollider();
  /// Takes a patch of `all`. It must exist until the next call. The contacts' keys last while the patch has the same
  /// id and pieces. `next_key` counts up for new contacts.
  void set(const SurfacePatches& all, const SurfacePatch& patch);
  /// Replaces `out` by the contacts. Its capacity bounds the number before the choice, and should be most_found.
  /// Proximity::piece is an index of the tool's pieces, and Proximity::triangle one of SurfacePatches::triangles.
  /// `vertices`: positions now, as many as the patches have.
  void detect(const Pose& tool, std::span<const Vec3> vertices, std::vector<Proximity>& out, std::uint64_t& next_key);
  /// The step's contacts, which the next choice continues: piece (an index of the tool's pieces), local, normal,
  /// tangent.
  void follow(std::span<const Proximity> contacts, std::uint64_t& next_key) {
    selection_.follow(contacts, patch_.spacing_m, next_key);
  }
  std::uint64_t id() const { return id_; }

  static constexpr std::size_t most_pieces = 32, most_triangles = 128, most_found = 1024, most_contacts = 24;

 private:
  void add_beside(const Pose& tool, int piece, std::vector<Proximity>& out) const;
  bool same_pieces(const SurfacePatches& all, const SurfacePatch& patch) const;

  std::uint64_t id_ = 0;
  SurfacePatch patch_;
  ToolCollider collider_;
  CollisionMesh mesh_;
  ContactSelection selection_;
  std::vector<std::array<int, 3>> triangles_;
  std::vector<Vec3> weighted_normals_;  ///< of all vertices of the patches; empty: not curved
  std::vector<std::uint8_t> open_;
  bool fresh_ = false;            ///< the mesh is that of an earlier patch
  std::vector<int> piece_index_;  ///< of the collider's pieces
  std::vector<char> touched_;     ///< whether the piece had a contact in the last detection
};

}  // namespace insula
