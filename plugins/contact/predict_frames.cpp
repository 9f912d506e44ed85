// SPDX-License-Identifier: GPL-3.0-or-later
// Prediction of contact frames after the step. A step's normals are those of its start. They are computed again at the
// later positions of tools and surfaces.
#include "core/collision/shapes/contact_normal_ahead.h"
#include "plugins/contact/contact.h"

namespace insula {

void Contact::predict_frames(double steps, std::vector<ContactFrame>& out) const {
  if (!(friction() > 0)) return;  // a single row has no other direction
  for (const Pair& p : pairs_) {
    if (!p.tool_collider || !p.active() || bounded(p)) continue;  // only a friction block has a frame
    const Pose now = p.tool_a->link_pose(p.link_a);
    const Vec6 motion = displacement(p.start, now);
    const auto vertex = [&](double after, int v) -> Vec3 {
      const Vec3& start = p.b->positions()[std::size_t(v)];
      if (p.b->body().blocks() == 0) return start;
      const Vec3 end = p.b->body().position(p.b->points()[std::size_t(v)]);
      return end + after * (end - start);
    };
    const auto nearest = [&](const Proximity& x, const Pose& pose, const std::function<Vec3(int)>& vertices) {
      return contact_normal_ahead(p.pieces_a[std::size_t(x.piece)], pose, p.b->collision(), vertices,
                                  pose.apply(x.local), spacing(), x.normal);
    };
    const auto nearest_after = [&](const Proximity& x, double after) {
      return nearest(x, displaced(now, after * motion), [&](int v) { return vertex(after, v); });
    };
    for (std::size_t i = 0; i < p.forces.size(); ++i) {
      const Proximity& x = p.contacts[i];
      if (!(p.forces[i][0] > 0)) continue;
      const auto normal = nearest_after(x, steps);
      if (!normal) continue;
      // Rotates the normal as far as the direction to the nearest point has rotated. A resting contact is not rotated,
      // even if its point changes.
      Vec3 to = *normal;
      if (x.time == 0 || (x.time == 1 && p.expected)) {
        const auto taken =
            nearest(x, x.time == 0 ? p.start : *p.expected, [&](int v) { return p.b->collision().vertex(v, x.time); });
        if (taken) to = Quat::FromTwoVectors(*taken, *normal) * x.normal;
      }
      if (!(to.dot(x.normal) > 0)) continue;
      const auto later = nearest_after(x, steps + 1);
      out.push_back({p.rows[i], x.normal, x.tangent, to, later ? Quat::FromTwoVectors(*normal, *later) * to : to});
    }
  }
}

}  // namespace insula
