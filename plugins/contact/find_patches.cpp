// SPDX-License-Identifier: GPL-3.0-or-later
// Triangles near the tools of the hands, for contacts between steps.
#include <algorithm>
#include <array>
#include <cmath>

#include "core/collision/shapes/core_triangle.h"
#include "core/collision/shapes/placed_piece.h"
#include "plugins/contact/contact.h"

namespace insula {
namespace {

constexpr double reach_m = 2.2e-3;  // of the tool's surface: a patch of a dozen vertices on a lobe
constexpr int steps_ahead = 2;      // until the next problem is in use
constexpr double later_m = 0.2e-3;  // what is near now precedes what is near after a step

constexpr double still_m = 0.05e-3;  // a tool that moves less in a step needs no look ahead

/// Distance of the triangle to the piece, m; more than `limit` if it is farther away.
double clear_of(const PlacedPiece& at, const std::array<Vec3, 3>& tri, double limit) {
  // First a bound: sphere about the triangle, segment in the core.
  const Vec3 centre = (tri[0] + tri[1] + tri[2]) / 3;
  const double size2 =
      std::max({(tri[0] - centre).squaredNorm(), (tri[1] - centre).squaredNorm(), (tri[2] - centre).squaredNorm()});
  const double s = closest_on_segment(centre, at.axis0, at.axis1);
  const double bound = (at.axis0 + s * (at.axis1 - at.axis0) - centre).norm() - std::sqrt(size2) - at.bound - at.radius;
  return bound > limit ? bound : core_triangle(at.core(), tri, at.radius + limit).distance - at.radius;
}

Aabb box_of(const PlacedPiece& at) {
  Aabb box;
  for (const Vec3& q : at.core()) box.add(q);
  box.inflate(at.radius);
  return box;
}

}  // namespace

/// The contacts of a wide blade stay with the vertices, and a bounded force has no friction block: both keep the rows
/// of the step.
void Contact::find_patches(std::vector<PatchCandidate>& out) const {
  if (!(friction() > 0)) return;
  for (const Pair& p : pairs_) {
    if (!p.tool_collider || !p.in_hand || !p.active() || bounded(p)) continue;
    const Pose now = p.tool_a->link_pose(p.link_a);
    const Vec6 motion = displacement(p.start, now);
    const CollisionMesh& mesh = p.b->collision();
    const bool moves = p.b->body().blocks() > 0;
    const auto vertex = [&](int v) {
      return moves ? p.b->body().position(p.b->points()[std::size_t(v)]) : p.b->positions()[std::size_t(v)];
    };
    const double half_thickness = 0.5 * p.b->thickness();
    const int last_ahead = motion.head<3>().norm() + 0.1 * motion.tail<3>().norm() > still_m ? steps_ahead : 0;
    PatchCandidate near;
    for (int index = 0; index < int(p.pieces_a.size()); ++index) {
      const RoundedPiece& piece = p.pieces_a[std::size_t(index)];
      const std::size_t before = near.triangles.size();
      for (int ahead = 0; ahead <= last_ahead; ++ahead) {
        const PlacedPiece at(piece, index, now, displaced(now, ahead * motion), 0, Vec3::Zero(), half_thickness);
        Aabb box = box_of(at);
        box.inflate(reach_m + mesh.farthest_free());  // the tree is that of the step's start
        mesh.tree().overlapping(box, [&](int t) {
          const auto& v = mesh.triangle(t);
          const double clear = clear_of(at, {vertex(v[0]), vertex(v[1]), vertex(v[2])}, reach_m);
          if (clear <= reach_m) near.triangles.push_back({t, clear + ahead * later_m});
        });
      }
      if (near.triangles.size() == before) continue;
      PatchPiece& to = near.pieces.emplace_back();
      to.index = index;
      to.first_core = int(near.core.size());
      to.cores = int(piece.core.size());
      near.core.insert(near.core.end(), piece.core.begin(), piece.core.end());
      to.radius = piece.radius;
      to.axis0 = piece.axis0;
      to.axis1 = piece.axis1;
      to.bound = piece.bound;
    }
    if (near.triangles.empty()) continue;
    for (std::size_t i = 0; i < p.rows.size() && i < p.contacts.size(); ++i) {
      const Proximity& x = p.contacts[i];
      near.contacts.push_back({p.rows[i], x.piece, x.triangle, x.bary});
      if (i < p.forces.size() && p.forces[i][0] > 0) near.triangles.push_back({x.triangle, -reach_m});
    }
    near.surface = p.b;
    near.tool = p.tool_a;
    near.law.id = row_id(*this, std::uint64_t(3) << 42 | std::uint64_t(&p - pairs_.data()));
    near.law.friction = friction();
    near.law.compliance_m_per_N = compliance(p);
    near.law.curved = curved() ? 1 : 0;
    near.law.alarm_m = alarm();
    near.law.spacing_m = spacing();
    near.law.half_thickness_m = half_thickness;
    near.law.max_correction_m = max_correction_of(p);
    near.law.max_contacts = max_contacts();
    near.law.max_per_piece = max_contacts_per_piece(p);
    out.push_back(std::move(near));
  }
}

}  // namespace insula
