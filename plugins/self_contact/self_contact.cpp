// SPDX-License-Identifier: GPL-3.0-or-later
/*
# self_contact

Contact of a thin wall with itself. The walls of a vessel then lie on each other when it is pressed flat:

    <self_contact on="artery_surface" thickness="0.3 mm" friction="0.3"/>

The surface's triangles are the middle surface of the wall. A sampled vertex and the triangle that faces it across the
lumen make one block, as in <contact>:

    gap = distance - thickness,   0 <= gap(end) _|_ force >= 0,   |f_t| <= mu f_n

`contact_stiffness` is the contact stiffness by which the wall itself becomes thinner there: delta + lambda /
contact_stiffness = gap. Without it, rigid jaws rest only on the wall's thickest fold, near the hinge. They hold the
rest loosely, and the pulse pulls it out, beat by beat. A wall that yields a little is gripped all along the blade. The
stiffness is E A / t: 3 kN/m is 1 MPa under 0.7 mm2 of 0.22 mm.

`sides="outer"` or `"both"` also handles the outer sides, such as a sac against its branch. The rest shape tells to
which side a pair belongs (`core/collision/colliders/self_collider.h`). Walls that have crossed are thus recognised and
separate again.

A thin wall yields between its contacts. Every point that a tool or a clip presses on (a contact of `<contact>`)
therefore has a support of its own. It is one row without friction between that point and the one behind it, along the
tool's normal. Supports search as far ahead as tools may move in a step (`max_step_displacement` of `<contact>`). Even a
fast tool then cannot press one wall through the other. `max_contacts` and `max_supports` bound the rows: three for each
contact, one for each support.

Sources: contact law as in <contact>; the side by the rest shape and the supports are our own.
*/
#include "plugins/self_contact/self_contact.h"

#include <algorithm>

#include "core/registry/registry.h"
#include "core/sim/simulation.h"

namespace insula {

void SelfContact::connect(PrepareContext& context, Simulation& simulation) {
  if (on->body().blocks() == 0)
    return error(context, on, "on: \"" + on->id + "\" never moves, so it cannot touch itself");
  if (!on->contact()) return error(context, on, "on: \"" + on->id + "\" is for the picture alone (contact=\"false\")");
  const auto& rest = on->rest();
  on->will_collide();
  collider_ = std::make_unique<SelfCollider>(rest.vertices, rest.triangles, 0.75 * spacing(), thickness());
  workers_ = &simulation.workers();
  for (Constraint* c : simulation.constraints())
    if (const auto* touch = dynamic_cast<const Contact*>(c)) touches_.push_back(touch);
  const std::size_t room = 2 * collider_->samples().size();
  contacts_.reserve(room);
  supports_.reserve(std::size_t(max_supports()));
  pressed_.reserve(256);
  selection_.reserve(room, std::size_t(max_contacts()));
  rows_.reserve(std::size_t(max_contacts()));
  forces_.reserve(std::size_t(max_contacts()));
}

void SelfContact::detect(const StepContext&) {
  SelfContactSettings settings;
  settings.thickness = thickness();
  settings.alarm = alarm();
  settings.max_correction = max_correction();
  settings.normal_under_relaxation = contact_stiffness() > 0;
  settings.inner = !sides.is("outer");
  settings.outer = !sides.is("inner");
  contacts_.clear();
  collider_->detect(on->collision(), settings, contacts_, *workers_);
  SelectionSettings choice;
  choice.spacing = spacing();
  choice.advantage = 0.5 * alarm();
  choice.max_contacts = max_contacts();
  choice.both_ends = true;
  selection_.select(contacts_, choice, next_key_);
}

// Called in build(), when every <contact> has found its contacts.
void SelfContact::find_supports() {
  supports_.clear();
  if (sides.is("outer")) return;
  const double near2 = 0.25 * spacing() * spacing();
  for (const Contact* c : touches_)
    for (const Contact::Pair& p : c->pairs()) {
      if (!p.tool_a || !p.b || p.b != &*on) continue;
      const double far = thickness() + alarm() + 2 * c->max_step_displacement();
      // Ordered by key instead of gap, so that supports do not change while nothing moves.
      pressed_.clear();
      for (const Proximity& x : p.contacts) pressed_.emplace_back(x.key, &x);
      std::sort(pressed_.begin(), pressed_.end());
      for (const auto& [contact, at] : pressed_) {
        const Proximity& x = *at;
        if (int(supports_.size()) >= max_supports()) return;
        const Opposite o = collider_->opposite(on->collision(), x.triangle, x.bary, -x.normal, far);
        if (o.triangle < 0) continue;
        // Two jaws give the same pair from both sides.
        const Vec3 here = on->collision().point(x.triangle, x.bary), there = on->collision().point(o.triangle, o.bary);
        bool known = false;
        for (const Support& s : supports_) {
          const Vec3 a = on->collision().point(s.triangle, s.bary), b = on->collision().point(s.behind, s.behind_bary);
          known = known || ((a - here).squaredNorm() < near2 && (b - there).squaredNorm() < near2) ||
                  ((a - there).squaredNorm() < near2 && (b - here).squaredNorm() < near2);
        }
        if (known) continue;
        const std::uint64_t key =
            std::uint64_t(1) << 43 | std::uint64_t(c->order & 0xffff) << 26 | (contact & 0x3ffffff);
        supports_.push_back(
            {x.triangle, o.triangle, x.bary, o.bary, x.normal, o.distance - thickness(), row_id(*this, key), -1, 0});
      }
    }
}

void SelfContact::add_row(ConstraintBuilder& builder, int row, const Proximity& x, const Vec3& d) const {
  builder.point(row, on->points()[std::size_t(x.vertex)], d);
  builder.surface_point(row, *on, x.triangle, x.bary, -d);
}

void SelfContact::build(const StepContext&, ConstraintBuilder& builder) {
  find_supports();
  const double compliance = contact_stiffness() > 0 ? 1 / contact_stiffness() : 0;
  for (Support& s : supports_) {
    Block block;
    block.id = s.id;
    block.role = BlockRole::contact;
    block.lower = 0;
    block.compliance = compliance;
    s.row = builder.add(block);
    builder.violation(s.row, std::max(s.gap, -max_correction()));
    builder.surface_point(s.row, *on, s.triangle, s.bary, s.normal);
    builder.surface_point(s.row, *on, s.behind, s.behind_bary, -s.normal);
  }
  rows_.clear();
  for (const Proximity& x : contacts_) {
    Block block;
    block.id = row_id(*this, x.key);
    block.role = BlockRole::contact;
    block.compliance = compliance;
    if (friction() > 0) {
      block.law = LawKind::friction;
      block.friction = friction();
    } else {
      block.lower = 0;
    }
    const int row = builder.add(block);
    rows_.push_back(row);
    builder.violation(row, x.start_gap);
    add_row(builder, row, x, x.normal);
    if (friction() > 0) {
      add_row(builder, row + 1, x, x.tangent);
      add_row(builder, row + 2, x, x.normal.cross(x.tangent));
    }
  }
}

void SelfContact::finish(const StepContext&, const ConstraintSolution& solution) {
  for (Support& s : supports_) s.force = solution.lambda[s.row];
  forces_.clear();
  for (std::size_t i = 0; i < rows_.size(); ++i) {
    const double* f = solution.lambda + rows_[i];
    forces_.push_back(friction() > 0 ? Vec3(f[0], f[1], f[2]) : Vec3(f[0], 0, 0));
  }
}

void SelfContact::report(StepReport& out) const {
  for (const Support& s : supports_) {
    ContactPoint c;
    c.a = c.b = &on->body();
    c.part_a = c.part_b = {&*on, 0};
    c.position = on->collision().point(s.behind, s.behind_bary);
    c.normal = s.normal;
    c.gap = s.gap;
    c.normal_force = s.force;
    c.tangent_force.setZero();
    out.contacts.push_back(c);
  }
  for (std::size_t i = 0; i < forces_.size(); ++i) {
    const Proximity& x = contacts_[i];
    ContactPoint c;
    c.a = c.b = &on->body();
    c.part_a = c.part_b = {&*on, 0};
    c.position = x.point;
    c.normal = x.normal;
    c.gap = x.start_gap;
    c.normal_force = forces_[i][0];
    c.tangent_force = forces_[i][1] * x.tangent + forces_[i][2] * x.normal.cross(x.tangent);
    out.contacts.push_back(c);
  }
}

void SelfContact::estimate_cost(CostCounts& out) const {
  out.self_vertices += int(on->rest().vertices.size());
  out.searched.push_back(on.get());
}

void SelfContact::reset() {
  next_key_ = 0;
  selection_.reset();
  if (collider_) collider_->reset();
  contacts_.clear();
  supports_.clear();
  rows_.clear();
  forces_.clear();
}

void SelfContact::append_state(std::vector<double>& out) const {
  for (const Support& s : supports_) out.push_back(s.force);
  for (std::size_t i = 0; i < forces_.size(); ++i) {
    out.push_back(double(contacts_[i].key));
    for (int k = 0; k < 3; ++k) out.push_back(forces_[i][k]);
  }
}

}  // namespace insula

INSULA_PLUGIN(self_contact) {
  registry.add<insula::SelfContact>("self_contact", insula::Kind::constraint,
                                    "contact of a thin wall with itself, across the lumen or outside");
}
