// SPDX-License-Identifier: GPL-3.0-or-later
// The pairs of bodies and tools of a <contact>, and their colliders. They are determined once, at the start of the
// scene.
#include <algorithm>

#include "core/sim/simulation.h"
#include "plugins/contact/contact.h"

namespace insula {

// Whether this element handles a pair that several elements may name.
bool Contact::owns(Simulation& simulation, const Body* a, const Body* b) const {
  const auto names = [](const Contact& c, const Body* body) {
    return std::find(c.between().begin(), c.between().end(), body) != c.between().end();
  };
  for (const Constraint* other : simulation.constraints()) {
    const auto* c = dynamic_cast<const Contact*>(other);
    if (!c || c == this || !names(*c, a) || !names(*c, b)) continue;
    if (c->between().size() < between().size()) return false;
    if (c->between().size() == between().size() && c->order > order) return false;
  }
  return true;
}

void Contact::add_pairs(Simulation& simulation, Body* a, Body* b) {
  auto* tool_a = dynamic_cast<RigidBody*>(a);
  auto* tool_b = dynamic_cast<RigidBody*>(b);
  if (tool_b && !tool_a) return add_pairs(simulation, b, a);
  constexpr std::size_t room = 2048;  // proximities before selection
  if (tool_a && tool_b) {
    for (int i = 0; i < tool_a->links(); ++i)
      for (int j = 0; j < tool_b->links(); ++j) {
        Pair p;
        p.tool_a = tool_a;
        p.tool_b = tool_b;
        p.link_a = i;
        p.link_b = j;
        for (const ConvexPiece& piece : tool_a->link_pieces(i)) p.pieces_a.push_back(rounded(piece));
        for (const ConvexPiece& piece : tool_b->link_pieces(j)) p.pieces_b.push_back(rounded(piece));
        p.contacts.reserve(room);
        pairs_.push_back(std::move(p));
      }
    return;
  }
  for (Surface* sb : b->children_of<Surface>()) {
    if (!sb->contact()) continue;
    sb->will_collide();
    if (tool_a) {
      for (int i = 0; i < tool_a->links(); ++i) {
        Pair p;
        p.tool_a = tool_a;
        p.link_a = i;
        p.b = sb;
        const auto* instrument = dynamic_cast<const Instrument*>(tool_a);
        p.in_hand = instrument && instrument->hand_index() >= 0;
        for (const ConvexPiece& piece : tool_a->link_pieces(i)) p.pieces_a.push_back(rounded(piece));
        if (contact_geometry.is("vertices"))
          p.vertex_collider =
              std::make_unique<VertexCollider>(tool_a->link_pieces(i), sb->triangles(), sb->rest().vertices);
        else
          p.tool_collider = std::make_unique<ToolCollider>(tool_a->link_pieces(i), p.b->collision().triangle_count());
        p.contacts.reserve(room);
        pairs_.push_back(std::move(p));
      }
      continue;
    }
    for (Surface* sa : a->children_of<Surface>()) {
      if (!sa->contact()) continue;
      Pair p;
      sa->will_collide();
      p.a = sa;
      p.b = sb;
      const double distance = 0.75 * tissue_spacing();
      p.a_on_b = std::make_unique<TissueCollider>(sample_vertices(sa->rest().vertices, sa->triangles(), distance),
                                                  sa->rest().vertices, p.b->collision().triangle_count());
      p.b_on_a = std::make_unique<TissueCollider>(sample_vertices(sb->rest().vertices, sb->triangles(), distance),
                                                  sb->rest().vertices, p.a->collision().triangle_count());
      p.contacts.reserve(p.a_on_b->samples().size() + p.b_on_a->samples().size());
      p.reverse.reserve(p.b_on_a->samples().size());
      pairs_.push_back(std::move(p));
    }
  }
}

void Contact::connect(PrepareContext& context, Simulation& simulation) {
  const auto& all = between();
  if (all.size() < 2) return error(context, between, "between: contact needs two names or more");
  for (std::size_t i = 0; i < all.size(); ++i) {
    if (dynamic_cast<RigidBody*>(all[i])) continue;
    const auto surfaces = all[i]->children_of<Surface>();
    if (std::none_of(surfaces.begin(), surfaces.end(), [](const Surface* s) { return s->contact(); }))
      return error(context, between, "between: \"" + all[i]->id + "\" has no surface to touch; give it a <surface/>");
  }
  if (std::all_of(all.begin(), all.end(), [](const Body* b) { return b->blocks() == 0; }))
    return error(context, between, "between: none of these can move");
  for (std::size_t i = 0; i < all.size(); ++i)
    for (std::size_t j = i + 1; j < all.size(); ++j) {
      if (all[i]->blocks() == 0 && all[j]->blocks() == 0) continue;
      if (owns(simulation, all[i], all[j])) add_pairs(simulation, all[i], all[j]);
    }
  for (Pair& p : pairs_) {
    const std::size_t most = std::size_t(p.tool_a ? max_contacts() : tissue_max_contacts());
    p.selection.reserve(p.contacts.capacity() + p.reverse.capacity(), most);
    p.contacts.reserve(p.contacts.capacity() + p.reverse.capacity());
    p.rows.reserve(most);
    if (p.vertex_collider && patch() > 0 && friction() > 0)
      p.patches = std::make_unique<FrictionPatches>(patch(), most);
    p.forces.reserve(most);
  }
  // Pairs of surfaces take longest, so they come first, and threads end together.
  workers_ = &simulation.workers();
  for (const bool surfaces : {true, false})
    for (int i = 0; i < int(pairs_.size()); ++i) {
      const bool both = pairs_[std::size_t(i)].a != nullptr;
      if (both != surfaces) continue;
      searches_.push_back({i, false});
      if (both) searches_.push_back({i, true});
    }
}

}  // namespace insula
