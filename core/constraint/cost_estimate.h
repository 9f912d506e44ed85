// SPDX-License-Identifier: GPL-3.0-or-later
// What a constraint will cost in a step, as counts that do not depend on the machine. tools/workbench/cost_model.h
// turns them into times.
#pragma once
#include <vector>

namespace insula {

class Body;
class RigidBody;
class Surface;

/// Rows that come when a tool or an implant is at work on a body.
struct RowEstimate {
  const RigidBody* tool;  ///< whose work brings them
  const Body* body;       ///< the other body
  double expected;        ///< rows in ordinary use; 0: none are expected from this pair
  double most;            ///< rows at the limit
};

/// Filled by Constraint::estimate_cost(); every constraint adds to what is there.
struct CostCounts {
  std::vector<RowEstimate> rows;
  std::vector<const Surface*> searched;  ///< surfaces whose search trees are brought up to date, with repetitions
  int tissue_vertices = 0;               ///< over pairs of surfaces that may touch, the vertices of both
  int tool_pieces = 0;                   ///< over pairs of an active tool and a surface, the tool's convex pieces
  int self_vertices = 0;                 ///< vertices of surfaces that may touch themselves
};

}  // namespace insula
