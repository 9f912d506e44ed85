// SPDX-License-Identifier: GPL-3.0-or-later
#include "core/sim/structure_forces.h"

#include "core/mechanics/instrument.h"
#include "core/mechanics/rigid_body.h"
#include "core/sim/report.h"

namespace insula {

StructureForces::StructureForces(const std::vector<Body*>& bodies) {
  for (const Body* b : bodies) {
    if (const auto* rigid = dynamic_cast<const RigidBody*>(b)) rigid_.push_back(rigid);
    else none_.push_back({b});
  }
}

int StructureForces::hand_of(const Body* body) {
  const auto* rigid = dynamic_cast<const RigidBody*>(body);
  while (rigid && rigid->held_by()) rigid = rigid->held_by();
  const auto* tool = dynamic_cast<const Instrument*>(rigid);
  return tool && tool->active() ? tool->hand_index() : -1;
}

void StructureForces::read(const ConstraintProblem& problem, const std::vector<ContactPoint>& contacts,
                           std::vector<StructureForce>& out) {
  out = none_;
  structure_of_row_.assign(std::size_t(problem.rows), -1);
  for (std::size_t s = 0; s < out.size(); ++s)
    for (const int row : out[s].body->rows.row) structure_of_row_[std::size_t(row)] = int(s);
  for (const RigidBody* body : rigid_) {
    const int hand = hand_of(body);
    if (hand < 0) continue;
    const BodyRows& rows = body->rows;
    for (int i = 0; i < rows.count(); ++i) {
      const int row = rows.row[std::size_t(i)], s = structure_of_row_[std::size_t(row)];
      if (s < 0) continue;
      // Block 0 of a rigid body is its translation. The row pushes the structure the opposite way.
      for (int e = rows.start[std::size_t(i)]; e < rows.start[std::size_t(i) + 1]; ++e)
        if (rows.block[std::size_t(e)] == 0)
          out[std::size_t(s)].of_hand[std::size_t(hand)] -=
              problem.lambda[std::size_t(row)] * rows.coeff[std::size_t(e)];
    }
  }
  for (StructureForce& s : out) {
    if (s.body->blocks() > 0) continue;
    for (const ContactPoint& c : contacts) {
      if (c.a != s.body && c.b != s.body) continue;
      const bool first = c.a == s.body;
      const int hand = hand_of(first ? c.b : c.a);
      if (hand >= 0)
        s.of_hand[std::size_t(hand)] += (first ? 1.0 : -1.0) * (c.normal_force * c.normal + c.tangent_force);
    }
  }
}

}  // namespace insula
