// SPDX-License-Identifier: GPL-3.0-or-later
#include "engine/live/shown_contacts.h"

#include <algorithm>

#include "core/sim/structure_forces.h"

namespace insula {
namespace {

struct Rank {
  bool of_hand = false;
  double force = 0;  ///< N
  std::size_t index = 0;
  bool before(const Rank& other) const {
    if (of_hand != other.of_hand) return of_hand;
    if (force != other.force) return force > other.force;
    return index < other.index;
  }
};

}  // namespace

std::vector<std::size_t> shown_contacts(const std::vector<ContactPoint>& contacts, std::size_t most) {
  std::vector<Rank> ranks;
  ranks.reserve(contacts.size());
  for (const ContactPoint& c : contacts)
    ranks.push_back({StructureForces::hand_of(c.a) != StructureForces::hand_of(c.b), c.normal_force, ranks.size()});
  const std::size_t n = std::min(most, ranks.size());
  std::partial_sort(ranks.begin(), ranks.begin() + std::ptrdiff_t(n), ranks.end(),
                    [](const Rank& a, const Rank& b) { return a.before(b); });
  std::vector<std::size_t> out(n);
  std::transform(ranks.begin(), ranks.begin() + std::ptrdiff_t(n), out.begin(), [](const Rank& r) { return r.index; });
  return out;
}

}  // namespace insula
