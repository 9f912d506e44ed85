// SPDX-License-Identifier: GPL-3.0-or-later
// Patches of contacts and their rows.
#include "plugins/contact/friction_patches.h"

#include <algorithm>
#include <cmath>

#include "core/collision/colliders/contact_selection.h"
#include "plugins/contact/contact.h"

namespace insula {
namespace {

constexpr double max_creep = 0.1e-3;  ///< a sticking patch with a larger offset is released, m

// Cell of the grid, and the nearest of six directions to the normal, both in the tool's frame. The grid's planes are
// half a cell off the tool's own planes, where faces may be.
std::uint32_t name_of(const Vec3& place, const Vec3& normal, double size) {
  std::uint32_t name = 0;
  for (int k = 0; k < 3; ++k) name = name << 8 | (std::uint32_t(int(std::floor(place[k] / size + 0.5)) + 128) & 0xff);
  int axis = 0;
  normal.cwiseAbs().maxCoeff(&axis);
  return name << 3 | std::uint32_t(2 * axis + (normal[axis] < 0));
}

}  // namespace

FrictionPatches::FrictionPatches(double size, std::size_t room) : size_(size) {
  members_.reserve(room);
  patches_.reserve(room);
  known_.reserve(room);
  held_.reserve(room);
}

const FrictionPatches::Known* FrictionPatches::known(std::uint64_t key) const {
  const auto at = std::lower_bound(known_.begin(), known_.end(), key,
                                   [](const Known& k, std::uint64_t wanted) { return k.key < wanted; });
  return at != known_.end() && at->key == key ? &*at : nullptr;
}

FrictionPatches::Held* FrictionPatches::held(std::uint32_t name) {
  const auto at = std::lower_bound(held_.begin(), held_.end(), name,
                                   [](const Held& h, std::uint32_t wanted) { return h.name < wanted; });
  return at != held_.end() && at->name == name ? &*at : nullptr;
}

void FrictionPatches::sort(std::span<const Proximity> contacts, const Pose& tool) {
  members_.clear();
  patches_.clear();
  for (Held& h : held_) {
    h.slip.setZero();
    h.weight = 0;
  }
  for (std::size_t i = 0; i < contacts.size(); ++i) {
    const Proximity& x = contacts[i];
    const Known* k = known(x.key);
    Held* h = k ? held(k->patch) : nullptr;
    const bool stays = h && h->holds;
    members_.push_back({stays ? k->patch : name_of(x.local, tool.q.conjugate() * x.normal, size_), int(i),
                        stays ? k->weight
                        : k   ? k->bore
                              : 0.0,
                        -1, stays});
    if (!h) continue;
    h->slip += k->weight * (k->local - x.local);
    h->weight += k->weight;
  }
  std::sort(members_.begin(), members_.end(), [](const Member& a, const Member& b) {
    return a.patch != b.patch ? a.patch < b.patch : a.contact < b.contact;
  });
  for (std::size_t first = 0; first < members_.size();) {
    std::size_t last = first;
    double sum = 0, kept = 0;
    int fresh = 0;
    Vec3 normal = Vec3::Zero();
    for (; last < members_.size() && members_[last].patch == members_[first].patch; ++last) {
      const Member& m = members_[last];
      if (m.stays) kept += m.weight;
      else sum += m.weight, ++fresh;
      normal += contacts[std::size_t(m.contact)].normal;
    }
    // Contacts without force get a small share, so that a new patch has a slip. Sticking contacts keep their shares,
    // and new ones get small shares.
    const double n = double(last - first), least = 0.1 * sum / n + 1e-9, new_share = kept > 0 ? 0.1 / n : 0;
    const double scale =
        kept > 0 && fresh == 0 && kept > 1 - 1e-12 ? 1 : 1 / (kept > 0 ? kept + fresh * new_share : sum + n * least);
    for (std::size_t i = first; i < last; ++i) {
      Member& m = members_[i];
      m.weight = scale * (m.stays ? m.weight : kept > 0 ? new_share : m.weight + least);
    }
    Patch p{members_[first].patch, int(first), int(last - first), {}, Vec3::Zero(), -1};
    if (const Held* h = held(p.name); h && h->holds && h->weight > 0) p.crept = h->crept + h->slip / h->weight;
    p.tangent[0] = tangent_to(normal.normalized(), tool.q * Vec3::UnitZ());
    p.tangent[1] = normal.normalized().cross(p.tangent[0]);
    patches_.push_back(p);
    first = last;
  }
}

void FrictionPatches::finish(std::span<const Proximity> contacts, const ConstraintSolution& solution, double mu,
                             std::vector<Vec3>& forces) {
  forces.resize(contacts.size());
  known_.clear();
  held_.clear();
  for (const Patch& p : patches_) {
    const Vec3 friction = solution.lambda[p.row] * p.tangent[0] + solution.lambda[p.row + 1] * p.tangent[1];
    double pressed_in_all = 0;
    for (int i = p.first; i < p.first + p.count; ++i) pressed_in_all += solution.lambda[members_[std::size_t(i)].row];
    // A slipping patch is released. members_ is in order of names.
    const bool holds = friction.norm() < (1 - 1e-6) * mu * pressed_in_all && p.crept.norm() < max_creep;
    held_.push_back({p.name, holds, p.crept, Vec3::Zero(), 0});
    for (int i = p.first; i < p.first + p.count; ++i) {
      const Member& m = members_[std::size_t(i)];
      const Proximity& x = contacts[std::size_t(m.contact)];
      const Vec3 share = m.weight * friction, other = x.normal.cross(x.tangent);
      const double pressed = solution.lambda[m.row];
      forces[std::size_t(m.contact)] = Vec3(pressed + share.dot(x.normal), share.dot(x.tangent), share.dot(other));
      known_.push_back({x.key, pressed, m.weight, x.local, p.name});
    }
  }
  std::sort(known_.begin(), known_.end(), [](const Known& a, const Known& b) { return a.key < b.key; });
}

void FrictionPatches::reset() {
  members_.clear();
  patches_.clear();
  known_.clear();
  held_.clear();
}

void Contact::build_patches(ConstraintBuilder& builder, Pair& p) {
  const Pose tool = p.tool_a->link_pose(p.link_a);
  p.patches->sort(p.contacts, tool);
  auto& members = p.patches->members();
  for (auto& one : p.patches->patches()) {
    for (int i = one.first; i < one.first + one.count; ++i) {
      auto& m = members[std::size_t(i)];
      const Proximity& x = p.contacts[std::size_t(m.contact)];
      Block block;
      block.id = row_id(*this, x.key);
      block.role = BlockRole::contact;
      block.lower = 0;
      block.upper = max_contact_force(p);
      block.compliance = compliance(p);
      m.row = builder.add(block);
      builder.violation(m.row, x.start_gap);
      add_row(builder, m.row, p, x, x.normal);
    }
    Block block;
    block.id = row_id(*this, std::uint64_t(1) << 42 | std::uint64_t(&p - pairs_.data()) << 28 | one.name);
    block.role = BlockRole::friction;
    block.law = LawKind::patch;
    block.friction = friction();
    block.normals = one.count;
    one.row = builder.add(block);
    for (int k = 0; k < 2; ++k) {
      builder.violation(one.row + k, one.tangent[k].dot(tool.q * one.crept));
      for (int i = one.first; i < one.first + one.count; ++i) {
        const auto& m = members[std::size_t(i)];
        add_row(builder, one.row + k, p, p.contacts[std::size_t(m.contact)], m.weight * one.tangent[k]);
      }
    }
  }
}

}  // namespace insula
