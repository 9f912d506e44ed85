// SPDX-License-Identifier: GPL-3.0-or-later
// The rows of one component, built at any state of the bodies outside a step, for the contracts.
#pragma once
#include <cstdint>
#include <map>
#include <string>
#include <utility>
#include <vector>

#include "core/mechanics/constraint.h"
#include "core/sim/simulation.h"

namespace insula::test {

struct RowData {
  Block block;
  int offset = 0;        ///< row within its block
  double violation = 0;  ///< at the start of the step, m
  double rate = 0;       ///< as the component declared it, m/s
  double swept = 0;      ///< displacement of the block's point in the free motion, m
  std::vector<VecX> h;   ///< one vector for each body, blocks() * 3 long

  /// Whether the law depends on the violation. Tangents of friction and rows of patches depend on the motion.
  bool positional() const { return block.law == LawKind::box || (block.law == LawKind::friction && offset == 0); }
  /// Whether the law is more than "delta = 0".
  bool has_law() const;
  double lower() const { return block.law == LawKind::box ? block.lower : 0.0; }
  double upper() const { return block.law == LawKind::box ? block.upper : infinite; }
  /// Energy of the row's law at its violation, J: the largest -(lambda delta + c lambda^2 / 2) within the bounds.
  double potential() const;
};

using RowKey = std::pair<std::uint64_t, int>;  ///< block id, row in the block
using RowMap = std::map<RowKey, RowData>;
std::string name_of(const RowKey& key, const RowData& row);  ///< "row 0 of key 12, violation 0.3 mm"

class RowBench {
 public:
  RowBench(Simulation& s, Component& c);
  /// Builds at the bodies' present state. `time`: from now, s.
  RowMap rows(double time = 0);
  std::vector<Block> blocks;  ///< of the last rows()

 private:
  VecX expected_motion(Body& body) const;
  void add_ways(std::vector<RowData*>& by_row) const;

  Simulation& simulation_;
  Component& component_;
  ConstraintProblem problem_;
  ConstraintBuilder builder_;
  StepContext context_;
};

/// Moves every body along dq (one vector for each body, blocks() * 3 long), once.
void move(Simulation& s, const std::vector<VecX>& dq, double scale);
/// No motion, to be filled in.
std::vector<VecX> no_motion(const Simulation& s);

/// Returns the bodies to their state at the object's construction.
class Restore {
 public:
  explicit Restore(Simulation& s);
  void operator()() const;

 private:
  Simulation& s_;
  std::vector<VecX> q_;
  std::vector<std::pair<Pose, double>> pose_;  ///< with the opening, rad
};

}  // namespace insula::test
