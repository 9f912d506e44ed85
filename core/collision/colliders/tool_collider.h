// SPDX-License-Identifier: GPL-3.0-or-later
// A rigid tool of rounded convex pieces against a surface, looking ahead over the step.
//
// Geometry is that of the start of the step. If the free motion is larger than the distance of what is near, geometry
// along it is used too: tool pose start -> free, surface x -> x + u. Each piece advances no faster than its distance to
// the surface allows (conservative advancement; Mirtich 1996), until it touches or the step ends. A fast tool therefore
// meets the surface that it would have passed through. Contacts are those within the alarm distance
//   - at the start,
//   - where the piece first touches, or at the end of its free motion,
//   - where it would be after sliding along what it touches by the rest of its motion.
// A contact found later in the step is used only if the tool starts on its free side. Its start_gap is measured between
// the same material points along the same normal. So start_gap + H dq is the gap at the end of the step.
//
// The normals of a step's start lag behind on a surface that rotates. `expected` is the expected pose of the
// tool at the end of the step. With it, a piece takes its contacts of the start, and of sliding, at that pose and on
// the surface where its motion leads it. Normals and contact points are then those of the end, and start_gap + H dq is
// the gap there. This is exact if both move as expected. A piece keeps the contacts of the start if it is behind the
// surface, would be behind a wall, or would be away.
//
// One triangle gives a contact only where the distance is also smallest among its neighbours, so inner edges give no
// ghost contacts. Corners of the core that are right above the triangle are added, since a flat or long piece lies on
// several points. The outward normals of the surface tell the sides. A core behind the surface has a negative gap and
// is pushed to the nearest point of the surface, as long as it is no deeper than max_depth. A core that passes through
// a triangle is pushed along its normal.
//
// Contacts with a `curved` surface are found on its flat triangles and moved to the nearest point of the curved ones.
// A core behind the surface keeps the direction of its flat contact.
//
// A hollow body that is pressed flat is thinner than a blade. What is behind its one wall is soon nearest to the other
// wall. So each piece remembers the side of the surface on which it was last outside, and never leaves towards the
// opposite side.
#pragma once
#include <array>
#include <span>
#include <vector>

#include "core/collision/proximity.h"
#include "core/collision/search/collision_mesh.h"
#include "core/model/tools/tool_model.h"

namespace insula {

struct ToolContactSettings {
  double alarm = 1e-3;           ///< m
  double max_correction = 1e-3;  ///< an overlap is reduced by at most this in a step, m
  double collision_horizon = 0;  ///< in steps: the tool's motion is followed this far beyond the step
  double max_depth = 5e-3;       ///< cores farther behind the surface are not pushed out, m
  bool one_sided = false;  ///< vertices: those behind a blade that presses a body from the front return to its front
  bool curved = false;     ///< triangles are curved as the surface's normals say (curved_contact.h)
  double offset = 0;       ///< the surface is the middle of a wall of twice this thickness, m
  const Pose* expected =
      nullptr;  ///< of the tool at the end of the step, scene frame; null: contacts of the start are taken at the start
};

/// A piece as used for collision: a core of at most 24 points, and a radius that is never 0. Flat blades are shrunk by
/// a fifth of a millimetre, or 0.45 of their smallest extent, and rounded by as much. Resting contact then keeps the
/// core clear of the surface, and normals are well defined.
struct RoundedPiece {
  static constexpr std::size_t max_core = 24;  ///< read_tool refuses more
  std::vector<Vec3> core;                      ///< tool frame
  double radius = 0;
  Vec3 axis0 = Vec3::Zero(), axis1 = Vec3::Zero();  ///< segment that the core lies about ...
  double bound = 0;                                 ///< ... within this distance
};
RoundedPiece rounded(const ConvexPiece& piece);
struct PlacedPiece;
struct CoreDistance;

/// One tool and one surface. Remembers which pieces overlapped in the last step, since their search reaches deeper, and
/// their sides. Allocates only in the constructor, as long as `out` has capacity.
class ToolCollider {
 public:
  ToolCollider(const std::vector<ConvexPiece>& pieces, int triangles);
  /// For pieces that change, at most so many; none at first.
  ToolCollider(std::size_t most_pieces, int triangles);
  /// Forgets all pieces and what it remembers of them. add_piece() returns the next one, to be filled in within the
  /// capacity of its core. Neither allocates.
  void clear_pieces();
  RoundedPiece& add_piece();
  std::span<const RoundedPiece> pieces() const { return {pieces_.data(), used_}; }
  /// Appends to `out`, piece by piece, in an order that depends on the arguments alone.
  void detect(const CollisionMesh& mesh, const Pose& start, const Pose& free, const ToolContactSettings& settings,
              std::vector<Proximity>& out);
  /// The contacts at this pose and the mesh's positions alone, with all of the mesh's triangles as candidates, for a
  /// mesh of few triangles. Those beyond the capacity of `out` are left out.
  void detect_at(const CollisionMesh& mesh, const Pose& pose, const ToolContactSettings& settings,
                 std::vector<Proximity>& out);
  void reset();
  /// Time in the last detect's step at which a piece first touched while it moved inward in its free motion; 1: none
  /// did.
  double touch_time() const { return touch_time_; }
  int touching_piece() const { return touching_piece_; }  ///< the first to touch, -1: none
  /// Overlap of that piece with the surface at the end of its free motion, m; 0 if it would be away, infinite if it
  /// would be nearest to the opposite wall.
  double overlap_at_end() const { return overlap_at_end_; }
  static constexpr std::size_t max_touch_normals = 64;
  /// Of the contacts that it then had, towards the tool; at most max_touch_normals.
  std::span<const Vec3> touch_normals() const { return touch_normals_; }

 private:
  struct Candidate {
    int triangle;
    double clear;   ///< lower bound of the unsigned gap ...
    double time;    ///< ... at this time
    double speed;   ///< bound on the relative motion over the whole step, m ...
    double to_end;  ///< ... and on that to where the piece is expected at its end
  };
  struct SweptPiece;  // of a piece in the step
  struct Reached;     // what it reached
  void list_candidates(const CollisionMesh& mesh, const SweptPiece& swept);
  Reached advance(const CollisionMesh& mesh, const SweptPiece& swept, const ToolContactSettings& settings, double range,
                  std::vector<Proximity>& out);
  bool take_contacts_of_start(const CollisionMesh& mesh, const SweptPiece& swept, const ToolContactSettings& settings,
                              std::vector<Proximity>& out);
  void slide_on(const CollisionMesh& mesh, const SweptPiece& swept, double t, const ToolContactSettings& settings,
                std::vector<Proximity>& out);
  double find_overlap(const CollisionMesh& mesh, const PlacedPiece& at, const ToolContactSettings& settings);
  void add_those_on_free_side(const ToolContactSettings& settings, std::vector<Proximity>& out) const;
  static void add(Proximity x, const ToolContactSettings& settings, std::vector<Proximity>& out);
  // Contacts at a moment (tool_contacts.cpp).
  struct ContactsOfTriangle;
  static bool within_range(Candidate& k, const PlacedPiece& at, const std::array<Vec3, 3>& tri, double range,
                           CoreDistance& n);
  bool remember_side(int piece, double radius);
  void evaluate(const CollisionMesh& mesh, const PlacedPiece& at, const ToolContactSettings& settings, double range,
                std::vector<Proximity>& found);
  bool found_at_end(const CollisionMesh& mesh, const PlacedPiece& expected, const ToolContactSettings& settings);
  void drop_wrong_exits(std::vector<Proximity>& found, const Vec3& side, double offset) const;

  std::vector<RoundedPiece> pieces_;
  std::size_t used_ = 0;    ///< of the pieces
  std::vector<char> deep_;  ///< per piece: overlapped in the last step
  std::vector<Vec3> side_;  ///< per piece: surface normal where it was last near and outside; zero: none known
  double touch_time_ = 1;
  int touching_piece_ = -1;
  double overlap_at_end_ = 0;
  std::vector<Vec3> touch_normals_;
  std::vector<Candidate> candidates_;
  std::vector<Proximity> found_, at_end_;
};

}  // namespace insula
