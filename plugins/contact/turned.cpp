// SPDX-License-Identifier: GPL-3.0-or-later
// Directions of contacts after the step. A step's normals are those of its start; they are found anew where tools and surfaces have come.
#include "core/collision/nearest_place.h"
#include "plugins/contact/contact.h"

namespace insula {

void Contact::turned(double steps, std::vector<Turn>& out) const {
  if (!(friction() > 0)) return;  // a single row knows no other direction
  for (const Pair& p : pairs_) {
    if (!p.tool_collider || !p.active()) continue;
    const Pose now = p.tool_a->link_pose(p.link_a), then = displaced(now, steps * displacement(p.start, now));
    const auto vertex = [&](int v) -> Vec3 {
      const Vec3& start = p.b->positions()[std::size_t(v)];
      if (p.b->body().blocks() == 0) return start;
      const Vec3 end = p.b->body().position(p.b->points()[std::size_t(v)]);
      return end + steps * (end - start);
    };
    for (std::size_t i = 0; i < p.forces.size(); ++i) {
      const Proximity& x = p.contacts[i];
      if (!(p.forces[i][0] > 0)) continue;
      const auto normal = nearest_place(p.pieces_a[std::size_t(x.piece)], then, p.b->collision(), vertex, then.apply(x.local), spacing(), x.normal);
      if (normal && normal->dot(x.normal) > 0) out.push_back({p.rows[i], x.normal, x.tangent, *normal});
    }
  }
}

}  // namespace insula
