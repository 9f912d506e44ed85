// SPDX-License-Identifier: GPL-3.0-or-later
/*
# contact

Signorini contact with Coulomb friction among the bodies and tools named in `between`:

    <contact between="frontal temporal floor" friction="0.1"/>
    <contact between="suction frontal temporal floor" friction="0.2"/>
    <contact between="suction frontal" friction="0.05"/>

The element handles every pair of the names, except two bodies that never move and a body with itself. One coefficient
holds for all pairs of an element. If several elements name a pair, the element with the fewest names applies, and
among equals the last one. A pair can therefore be given its own coefficient.

Each contact is one block. The gap at the end of the step and its force obey 0 <= gap _|_ force >= 0. The friction
|f_t| <= mu f_n opposes the slip of the step. The block has the normal row, then two tangent rows. Without friction it
has the normal row alone.

`max_force` bounds the force of one contact of a tool, gap _|_ force in [0, max_force]. Bodies that are pressed harder
go into one another, and come out when they are let go. Rigid bodies that are wedged among one another would otherwise
ask for any force. The normal row is then a block of its own, and two tangent rows follow it.

    gap(end) = gap(start) + n . (H dq)      n fixed over the step, from b to a

n is the normal at the start of the step. With `linearized_at="end"` it is the normal at the expected end of the step.
Surfaces are then expected where their motion in the last step leads them. A tool is expected to keep its offset from
its free pose. A tool that slides over an edge thus meets the new face in the step in which it gets there. A wrong
expectation changes n alone, not the law.

With `curved`, a tool meets a surface that is curved between its vertices as the normals there say
(`core/collision/shapes/curved_triangle.h`). Its contact with a round wall then has the direction and the gap of a round
body. With flat triangles, a tool that is drawn along a round wall feels each facet.

Tools are rounded convex pieces. They search ahead along their free motion, so that a contact exists before bodies
touch (`core/collision/colliders/tool_collider.h`). Surfaces meet by sampled vertices
(`core/collision/colliders/tissue_collider.h`). A surface with a `thickness` is the middle surface of a wall, and gaps
are measured to the wall's faces. A tool that goes into such a wall moves by no more than `max_step_displacement` in a
step, however fast the hand is. Rows on the tool alone limit it. A tool that leaves the wall is free.

`alarm` is the distance at which a contact enters the problem. The haptic loop needs it too, since it moves the tool
between steps. Contact forces act on both sides at the same point, on the triangle's side of the gap. A tool's contact
therefore adds neither a resultant force nor a moment. Between two surfaces the moment is exact once the gap is
closed.

A blade that meets a wall `contact_geometry="vertices"` has many contacts side by side. With a `patch`, contacts within
that length share one friction force, |f_t| <= mu sum of their f_n. It opposes their mean slip, weighted by the force of
each in the last step (`friction_patches.h`). This takes one row for each contact and two for each patch, instead of
three for each contact.

Sources: Dequidt et al. 2015, sections 3.3 and 3.4; Duriez, Dubois, Kheddar, Andriot 2006 (friction in the block
solve).
*/
#include "plugins/contact/contact.h"

#include <algorithm>
#include <utility>

#include "core/registry/registry.h"
#include "core/sim/simulation.h"

namespace insula {

namespace {
bool presses(const std::vector<Vec3>& forces) {
  return std::any_of(forces.begin(), forces.end(), [](const Vec3& f) { return f[0] > 0; });
}
}  // namespace

// A pressing tool is expected to keep its offset from its free pose of the last step.
void Contact::expect(Pair& p, const Pose& free) const {
  p.expected.reset();
  if (!p.tool_collider || !linearized_at.is("end")) return;
  if (p.free && presses(p.forces)) p.expected = displaced(free, displacement(*p.free, p.start));
  p.free = free;
}

// Tools that press each other are expected to keep their offsets from their free poses, too.
void Contact::search_tools(Pair& p, const Pose& free, const ToolContactSettings& settings) {
  ToolMotion a{p.start, free}, b{p.tool_b->link_pose(p.link_b), p.tool_b->link_free_pose(p.link_b)};
  const ToolMotion last_b = p.other.value_or(b);
  p.other = b;
  const bool expected = p.free && presses(p.forces);
  const Pose last_free = std::exchange(p.free, free).value_or(free);
  if (expected) {
    a.end = displaced(free, displacement(last_free, p.start));
    b.end = displaced(b.end, displacement(last_b.end, b.start));
  }
  detect_tools(p.pieces_a, a, p.pieces_b, b, settings, p.contacts);
}

void Contact::search(const Search& what) {
  Pair& p = pairs_[std::size_t(what.pair)];
  if (p.tool_a) {
    ToolContactSettings settings;
    settings.alarm = alarm();
    settings.collision_horizon = collision_horizon_;
    settings.max_correction = max_correction_of(p);
    settings.curved = curved();
    if (p.b && p.b->thickness() > 0) {
      settings.offset = 0.5 * p.b->thickness();
    } else {
      settings.one_sided = true;
    }
    p.contacts.clear();
    if (!p.active()) {
      p.other.reset();
      return p.free.reset();
    }
    const Pose free = p.tool_a->link_free_pose(p.link_a);
    p.start = p.tool_a->link_pose(p.link_a);
    expect(p, free);
    if (p.expected) settings.expected = &*p.expected;
    const Pose& start = p.start;
    if (p.tool_b) search_tools(p, free, settings);
    else if (p.vertex_collider) p.vertex_collider->detect(p.b->collision(), start, free, settings, p.contacts);
    else p.tool_collider->detect(p.b->collision(), start, free, settings, p.contacts);
    return;
  }
  TissueContactSettings settings;
  settings.alarm = tissue_alarm();
  settings.offset = 0.5 * (p.a->thickness() + p.b->thickness());
  auto& out = what.reverse ? p.reverse : p.contacts;
  out.clear();
  if (what.reverse) p.b_on_a->detect(p.b->collision(), p.a->collision(), settings, out);
  else p.a_on_b->detect(p.a->collision(), p.b->collision(), settings, out);
}

void Contact::detect(const StepContext& context) {
  collision_horizon_ = context.collision_horizon_s / context.h;
  workers_->run(int(searches_.size()), [this](int i) { search(searches_[std::size_t(i)]); });
  // Keys are given in the order of the pairs, for any number of threads.
  for (Pair& p : pairs_) {
    SelectionSettings choice;
    if (p.tool_a) {
      choice.spacing =
          p.vertex_collider && p.b->thickness() > 0 ? 0.0 : spacing();  // all of a wall's vertices are kept out
      choice.advantage = 0.2 * alarm();
      choice.max_contacts = max_contacts();
      choice.max_per_piece = max_contacts_per_piece(p);
    } else {
      choice.spacing = tissue_spacing();
      choice.advantage = 0.5 * tissue_alarm();
      choice.max_contacts = tissue_max_contacts();
      for (Proximity& x : p.reverse) {
        x.side = 1;
        p.contacts.push_back(x);
      }
    }
    p.selection.select(p.contacts, choice, next_key_);
  }
}

double Contact::max_correction_of(const Pair& p) const {
  return p.b && p.b->thickness() > 0 ? std::min(max_correction(), max_step_displacement()) : max_correction();
}

// A jaw is one piece and may use all contacts. Of several pieces, each gets at most half.
int Contact::max_contacts_per_piece(const Pair& p) const {
  return p.single_piece() || p.vertex_collider ? max_contacts() : std::max(2, (max_contacts() + 1) / 2);
}

double Contact::max_contact_force(const Pair& p) const {
  const double most = p.tool_a ? max_force() : tissue_max_force();
  return most > 0 ? most : infinite;
}

// Adds direction d of the relative displacement a - b at the contact.
void Contact::add_row(ConstraintBuilder& builder, int row, const Pair& p, const Proximity& x, const Vec3& d) const {
  if (p.tool_a) {
    builder.point(row, p.tool_a->link_point(p.link_a, x.local), d);
    if (p.tool_b) return builder.point(row, p.tool_b->link_point(p.link_b, x.other_local), -d);
    builder.surface_point(row, *p.b, x.triangle, x.bary, -d);
    return;
  }
  const Surface& vertex = x.side == 0 ? *p.a : *p.b;
  const Surface& face = x.side == 0 ? *p.b : *p.a;
  if (vertex.body().blocks() > 0) builder.point(row, vertex.points()[std::size_t(x.vertex)], d);
  builder.surface_point(row, face, x.triangle, x.bary, -d);
}

void Contact::build(const StepContext&, ConstraintBuilder& builder) {
  for (Pair& p : pairs_) {
    limit_motion(builder, p);
    if (p.patches) {
      build_patches(builder, p);
      continue;
    }
    p.rows.clear();
    for (const Proximity& x : p.contacts) p.rows.push_back(add_contact(builder, p, x));
  }
}

// The friction of a bounded contact is a patch of one contact, since a friction block has no bound.
int Contact::add_contact(ConstraintBuilder& builder, const Pair& p, const Proximity& x) const {
  Block block;
  block.id = row_id(*this, x.key);
  block.role = BlockRole::contact;
  block.compliance = compliance(p);
  const bool joined = friction() > 0 && !bounded(p);
  if (joined) {
    block.law = LawKind::friction;
    block.friction = friction();
  } else {
    block.lower = 0;
    block.upper = max_contact_force(p);
  }
  const int row = builder.add(block);
  if (friction() > 0 && !joined) {
    Block tangents;
    tangents.id = row_id(*this, std::uint64_t(1) << 43 | x.key);
    tangents.role = BlockRole::friction;
    tangents.law = LawKind::patch;
    tangents.friction = friction();
    tangents.normals = 1;
    builder.add(tangents);
  }
  builder.violation(row, x.start_gap);
  add_row(builder, row, p, x, x.normal);
  if (friction() > 0) {
    add_row(builder, row + 1, p, x, x.tangent);
    add_row(builder, row + 2, p, x, x.normal.cross(x.tangent));
  }
  return row;
}

void Contact::finish(const StepContext&, const ConstraintSolution& solution) {
  for (Pair& p : pairs_) {
    p.forces.clear();
    if (p.patches) {
      p.patches->finish(p.contacts, solution, friction(), p.forces);
      continue;
    }
    for (int row : p.rows) {
      Vec3 f(solution.lambda[row], 0, 0);
      if (friction() > 0) f = Vec3(f[0], solution.lambda[row + 1], solution.lambda[row + 2]);
      p.forces.push_back(f);
    }
  }
}

void Contact::report(StepReport& out) const {
  for (const Pair& p : pairs_)
    for (std::size_t i = 0; i < p.forces.size(); ++i) {
      const Proximity& x = p.contacts[i];
      ContactPoint c;
      c.a = x.side == 0 ? p.body_a() : p.body_b();
      c.b = x.side == 0 ? p.body_b() : p.body_a();
      c.part_a = x.side == 0 ? p.part_a() : p.part_b();
      c.part_b = x.side == 0 ? p.part_b() : p.part_a();
      c.position = x.point;
      c.normal = x.normal;
      c.gap = x.start_gap;
      c.normal_force = p.forces[i][0];
      c.tangent_force = p.forces[i][1] * x.tangent + p.forces[i][2] * x.normal.cross(x.tangent);
      out.contacts.push_back(c);
    }
}

void Contact::reset() {
  next_key_ = 0;
  for (Pair& p : pairs_) {
    p.selection.reset();
    if (p.tool_collider) p.tool_collider->reset();
    if (p.vertex_collider) p.vertex_collider->reset();
    if (p.a_on_b) p.a_on_b->reset();
    if (p.b_on_a) p.b_on_a->reset();
    if (p.patches) p.patches->reset();
    p.free.reset();
    p.other.reset();
    p.contacts.clear();
    p.rows.clear();
    p.forces.clear();
  }
}

void Contact::append_state(std::vector<double>& out) const {
  for (const Pair& p : pairs_)
    for (std::size_t i = 0; i < p.forces.size(); ++i) {
      out.push_back(double(p.contacts[i].key));
      for (int k = 0; k < 3; ++k) out.push_back(p.forces[i][k]);
    }
}

}  // namespace insula

INSULA_PLUGIN(contact) {
  registry.add<insula::Contact>("contact", insula::Kind::constraint, "contact with friction among bodies and tools");
}
