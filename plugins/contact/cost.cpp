// SPDX-License-Identifier: GPL-3.0-or-later
// Cost of a <contact> in a step: the surfaces that it searches, and the rows of tools at work.
#include <algorithm>

#include "plugins/contact/contact.h"

namespace insula {

void Contact::estimate_cost(CostCounts& out) const {
  constexpr double usual = 4,
                   patch_rows = 1.3;  // contacts of a tool at work with tissue; rows of a contact that shares a patch
  const double rows = friction() <= 0 ? 1 : patch() > 0 ? patch_rows : 3;
  const double limit = rows * max_contacts();
  const bool vertices = contact_geometry.is("vertices");
  for (const Pair& p : pairs_) {
    for (const Surface* f : {p.a, p.b})
      if (f) out.searched.push_back(f);
    if (!p.tool_a && p.a && p.b) out.tissue_vertices += int(p.a->rest().vertices.size() + p.b->rest().vertices.size());
    if (!p.tool_a || p.tool_b) continue;
    if (p.tool_a->active()) out.tool_pieces += int(p.pieces_a.size());
    if (p.body_b()->blocks() == 0) continue;
    if (!p.tool_a->implant())
      out.rows.push_back({p.tool_a, p.body_b(), std::min(rows * usual, limit), limit * (vertices ? 2 : 1)});
    else if (vertices && p.tool_a->links() > 1 && p.link_a > 0)
      out.rows.push_back({p.tool_a, p.body_b(), limit, limit});  // its jaws grip, but its coil does not
  }
}

}  // namespace insula
