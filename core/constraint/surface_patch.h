// SPDX-License-Identifier: GPL-3.0-or-later
// Parts of surfaces near the tools of the hands. Between steps, the servo finds contacts on them each millisecond
// (haptic_server/patch_contacts.h), in place of the contacts that the step found.
//
// A vertex has three rows of the problem, which are its displacement along x, y and z of the scene. No force acts on
// them in the problem (box, bounds [0, 0]), and their delta is 0 at the problem's lambda. Their W is the compliance of
// the surface, with the cross terms to all other rows. A vertex that cannot move has no rows. Scene frame, m.
#pragma once
#include <algorithm>
#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "core/base/math.h"

namespace insula {

struct PatchVertex {
  int row = -1;                  ///< first of its three rows; -1: it cannot move
  Vec3 position = Vec3::Zero();  ///< at the end of the step
  /// CollisionMesh::weighted_normal() of the whole surface at the start of the step; 0 if no patch there is curved.
  Vec3 weighted_normal = Vec3::Zero();
  bool operator==(const PatchVertex&) const = default;
};

struct PatchTriangle {
  std::array<std::int16_t, 3> corner{};  ///< indices of vertices, counter-clockwise seen from outside
  /// Bit k: the surface goes on beyond the edge from corner k to the next one, but the patch does not.
  std::uint8_t open = 0;
  bool operator==(const PatchTriangle&) const = default;
};

/// A rounded convex piece of the tool (core/collision/colliders/tool_collider.h), tool frame.
struct PatchPiece {
  int index = 0;                  ///< of the tool's pieces
  int first_core = 0, cores = 0;  ///< of SurfacePatches::core
  double radius = 0;
  Vec3 axis0 = Vec3::Zero(), axis1 = Vec3::Zero();
  double bound = 0;
  bool operator==(const PatchPiece&) const = default;
};

/// A friction contact of the step whose place is taken by the contacts that the servo finds.
struct ReplacedContact {
  int row = 0;       ///< first of its three rows
  int piece = 0;     ///< index of the tool's pieces
  int triangle = 0;  ///< of SurfacePatches::triangles
  Vec3 bary = Vec3::Zero();
  bool operator==(const ReplacedContact&) const = default;
};

/// A tool and a surface, and the law of their contacts.
struct SurfacePatch {
  std::uint64_t id = 0;  ///< stable from step to step, unique in a problem
  int tool = 0;          ///< of ConstraintProblem::tools
  double friction = 0;
  int curved = 0;                 ///< 1: its triangles are curved as the vertices' normals say
  double compliance_m_per_N = 0;  ///< of a contact, along the normal
  double alarm_m = 0, spacing_m = 0, half_thickness_m = 0, max_correction_m = 0;
  int max_contacts = 0, max_per_piece = 0;
  int first_triangle = 0, triangles = 0;
  int first_piece = 0, pieces = 0;
  int first_replaced = 0, replaced = 0;
  bool operator==(const SurfacePatch&) const = default;
};

/// All patches of a problem. Patches share vertices.
struct SurfacePatches {
  std::vector<SurfacePatch> patches;
  std::vector<PatchVertex> vertices;
  std::vector<PatchTriangle> triangles;
  std::vector<PatchPiece> pieces;
  std::vector<Vec3> core;
  std::vector<ReplacedContact> replaced;
  bool operator==(const SurfacePatches&) const = default;

  static constexpr std::size_t max_patches = 12, max_vertices = 256, max_triangles = 512, max_pieces = 64,
                               max_core = 512, max_replaced = 64;
  bool empty() const { return patches.empty(); }
  void clear() {
    patches.clear();
    vertices.clear();
    triangles.clear();
    pieces.clear();
    core.clear();
    replaced.clear();
  }
  /// So that a later assignment does not allocate.
  void reserve() {
    patches.reserve(max_patches);
    vertices.reserve(max_vertices);
    triangles.reserve(max_triangles);
    pieces.reserve(max_pieces);
    core.reserve(max_core);
    replaced.reserve(max_replaced);
  }
};

/// Gives all rows their new numbers, -1 for rows that are gone. Patches that need such a row are removed.
inline void renumber_rows(SurfacePatches& p, std::span<const int> new_row) {
  const auto at = [&](int row) { return new_row[std::size_t(row)]; };
  // A vertex without all of its rows, side by side, is of no use.
  const auto stays = [&](int row) { return at(row) >= 0 && at(row + 1) == at(row) + 1 && at(row + 2) == at(row) + 2; };
  std::erase_if(p.patches, [&](const SurfacePatch& patch) {
    for (int t = patch.first_triangle; t < patch.first_triangle + patch.triangles; ++t)
      for (const int v : p.triangles[std::size_t(t)].corner)
        if (const int row = p.vertices[std::size_t(v)].row; row >= 0 && !stays(row)) return true;
    for (int r = patch.first_replaced; r < patch.first_replaced + patch.replaced; ++r)
      if (!stays(p.replaced[std::size_t(r)].row)) return true;
    return false;
  });
  for (PatchVertex& v : p.vertices)
    if (v.row >= 0) v.row = stays(v.row) ? at(v.row) : -1;
  if (p.patches.empty()) return p.clear();
  int kept = 0;  // replaced contacts of the patches that stay; their order is that of the patches
  for (SurfacePatch& patch : p.patches) {
    for (int k = 0; k < patch.replaced; ++k) {
      ReplacedContact r = p.replaced[std::size_t(patch.first_replaced + k)];
      r.row = at(r.row);
      p.replaced[std::size_t(kept + k)] = r;
    }
    patch.first_replaced = kept;
    kept += patch.replaced;
  }
  p.replaced.resize(std::size_t(kept));
}

}  // namespace insula
