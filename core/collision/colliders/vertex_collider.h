// SPDX-License-Identifier: GPL-3.0-or-later
// Rounded convex pieces against the vertices of a finely meshed thin wall.
//
// Where the wall's triangles are about as small as a blade is thick, no piece can enter between vertices. Keeping every
// near vertex out of a piece then keeps the whole wall out of it. Unlike contacts of triangles (tool_collider.h) this
// needs no inside of the wall. A neck pressed flat between two jaws has none. Each vertex has one contact, with the
// nearest piece. The vertex identifies it from step to step.
//
// Edges that are drawn out to nearly twice their length at rest let a shut blade in between their ends. Points within
// such edges are kept out like vertices (stretched_edges.h), if the wall has a thickness.
//
// A vertex within the alarm distance at the start gives a contact there. A vertex that the free motion would bring in
// gives it at the moment of touch (conservative advancement; Mirtich 1996). A vertex remembers the direction in which
// it is kept out. If a thin piece has passed through it nevertheless, it is pushed back in the opposite direction.
#pragma once
#include <array>
#include <vector>

#include "core/collision/colliders/stretched_edges.h"
#include "core/collision/colliders/tool_collider.h"
#include "core/collision/proximity.h"
#include "core/collision/search/collision_mesh.h"

namespace insula {

class VertexCollider {
 public:
  /// rest: vertices of the wall, at least for as long as this collider exists, m.
  VertexCollider(const std::vector<ConvexPiece>& pieces, const std::vector<std::array<int, 3>>& triangles,
                 std::span<const Vec3> rest);
  /// Appends to `out` in order of vertices, then of points within edges. Allocates only in the constructor, as long as
  /// `out` has capacity.
  void detect(const CollisionMesh& mesh, const Pose& start, const Pose& free, const ToolContactSettings& settings,
              std::vector<Proximity>& out);
  void reset();

 private:
  struct Near {
    double clear;  ///< distance of the core less its radius and the wall's half thickness, m
    Vec3 normal;   ///< from the vertex to the core, unit; zero inside the core
  };
  Near nearest(const RoundedPiece& piece, const Pose& pose, const Vec3& x, double offset) const;

  struct Candidate {
    int piece;
    double at_least;  ///< lower bound of the result of nearest(), m
  };

  /// Data of a step that all vertices use.
  struct Step {
    const CollisionMesh& mesh;
    const Pose &start, &free;
    const ToolContactSettings& settings;
    const Vec6& motion;  ///< displacement from start to free
    double turn;         ///< angle of the motion, rad
  };
  /// A vertex of the wall, or a point within one of its edges.
  struct WallPoint {
    int triangle = -1;  ///< that contains it; -1: the vertex has none
    Vec3 bary = Vec3::Zero();
    Vec3 start, motion;  ///< position at the start of the step, displacement of the free motion
  };
  /// The direction in which a point within an edge was kept out.
  struct KeptPoint {
    int point;
    Vec3 direction;  ///< frame of the pieces
  };
  /// The piece that touches a vertex, and the time of the contact as a share of the step.
  struct Touch {
    int piece = -1;
    Near near{1e300, Vec3::Zero()};
    double when = 0;
  };
  void list_points(const Step& step);
  WallPoint wall_point(const CollisionMesh& mesh, int point) const;
  Vec3 kept_out(int point) const;
  bool list_pieces(const Step& step, const Vec3& local, double speed);
  Touch nearest_at_start(const Step& step, const Vec3& x0) const;
  Touch first_contact_on_path(const Step& step, const Vec3& x0, const Vec3& u, double speed) const;
  bool touch_of(const Step& step, const Vec3& x0, const Vec3& u, double speed, Vec3& memory, Touch& touch) const;
  static void add_contact(const Step& step, int point, const WallPoint& at, const Touch& touch,
                          std::vector<Proximity>& out);

  std::vector<RoundedPiece> pieces_;
  std::vector<Aabb> boxes_;  ///< of the pieces' cores
  std::vector<std::array<int, 2>>
      triangle_of_;             ///< one triangle of each vertex, and the vertex's corner in it; -1: none
  StretchedEdges edges_;        ///< its points have numbers from that of the vertices on
  std::vector<Vec3> kept_out_;  ///< per vertex: last normal, frame of the pieces; zero: none
  std::vector<KeptPoint> kept_points_, next_kept_points_;  ///< the same of points within edges, in their order
  Vec3 side_ = Vec3::Zero();  ///< mean direction from the pressing vertices to the core, frame of the pieces; at most
                              ///< of unit length
  std::vector<int> seen_;     ///< points near the pieces in this step
  std::vector<int> edge_points_;
  std::vector<int> seen_triangles_;
  std::vector<char> marked_, marked_triangles_;  ///< those seen; no mark outlives list_points()
  std::vector<Candidate> near_pieces_;           ///< of one vertex
};

}  // namespace insula
