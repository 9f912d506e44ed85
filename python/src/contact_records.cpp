// SPDX-License-Identifier: GPL-3.0-or-later
// From the report's contacts to records.
#include "python/src/contact_records.h"

#include <algorithm>

namespace insula::python {
namespace {

std::int32_t index_of(const Simulation& simulation, const Surface* surface) {
  const auto& all = simulation.surfaces();
  const auto at = std::find(all.begin(), all.end(), surface);
  return at == all.end() ? -1 : std::int32_t(at - all.begin());
}

void copy_to(double (&to)[3], const Vec3& v) { std::copy_n(v.data(), 3, to); }

}  // namespace

void ContactRecords::fill(const Simulation& simulation) {
  const std::vector<ContactPoint>& contacts = simulation.report().contacts;
  count_ = contacts.size();
  if (count_ > memory_->size()) memory_ = std::make_shared<std::vector<ContactRecord>>(2 * count_);
  for (std::size_t i = 0; i < count_; ++i) {
    const ContactPoint& c = contacts[i];
    ContactRecord& to = (*memory_)[i];
    to.body_a = c.a->index;
    to.body_b = c.b->index;
    to.surface_a = index_of(simulation, c.part_a.surface);
    to.surface_b = index_of(simulation, c.part_b.surface);
    copy_to(to.position, c.position);
    copy_to(to.normal, c.normal);
    to.gap = c.gap;
    to.normal_force = c.normal_force;
    copy_to(to.tangent_force, c.tangent_force);
  }
}

}  // namespace insula::python
