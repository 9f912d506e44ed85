// SPDX-License-Identifier: GPL-3.0-or-later
// Expected cost of a constraint in a step, as counts that do not depend on the machine. tools/workbench/cost_model.h
// converts them to times.
#pragma once
#include <vector>

namespace insula {

class Body;
class RigidBody;
class Surface;

/// Rows that are added while a tool or an implant works on a body.
struct RowEstimate {
  const RigidBody* tool;  ///< the tool or implant
  const Body* body;       ///< the other body
  double expected;        ///< rows in ordinary use; 0: none are expected from this pair
  double most;            ///< rows at the limit
};

/// Filled by Constraint::estimate_cost(); every constraint adds to what is there.
struct CostCounts {
  std::vector<RowEstimate> rows;
  std::vector<const Surface*> searched;  ///< surfaces whose search trees are updated, with repetitions
  int tissue_vertices = 0;               ///< over pairs of surfaces that may touch, the vertices of both
  int tool_pieces = 0;                   ///< over pairs of an active tool and a surface, the tool's convex pieces
  int self_vertices = 0;                 ///< vertices of surfaces that may touch themselves
};

}  // namespace insula
