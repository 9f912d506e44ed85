// SPDX-License-Identifier: GPL-3.0-or-later
// Base of every constraint plugin: adds rows to the step's problem and reads their lambda afterwards.
#pragma once
#include <memory>
#include <vector>

#include "core/constraint/contact_frame.h"
#include "core/constraint/cost_estimate.h"
#include "core/constraint/problem.h"
#include "core/mechanics/body.h"
#include "core/mechanics/patch_candidate.h"
#include "core/mechanics/step_context.h"
#include "core/registry/component.h"

namespace insula {

class Surface;

/// Collects the rows of all constraints. For every row, delta_free = violation at the start of the step + H dq_free.
/// The bodies add the second term together with W (Body::add_free_motion).
class ConstraintBuilder {
 public:
  ConstraintBuilder(ConstraintProblem& problem, const std::vector<Body*>& bodies)
      : problem_(problem), bodies_(bodies) {}

  /// Blocks added from now on belong to this component. The simulation calls it before each build().
  void set_owner(const Component& c) { owner_ = c.order; }
  /// Adds a block of one row (box) or three (friction), and fills in `block.row` and `block.owner`. Returns the first
  /// row.
  int add(Block block);
  /// Violation of a row at the start of the step, metres (for contact: the gap).
  void violation(int row, double value) { delta_[std::size_t(row)] += value; }
  /// H(row) += d . d(point). Rows come in ascending order.
  void point(int row, const MaterialPoint& p, const Vec3& d);
  /// The same for a point of a surface's triangle.
  void surface_point(int row, const Surface& s, int triangle, const Vec3& bary, const Vec3& d);
  /// Sets the rate (m/s) at which the row's violation changes by itself between steps. A limit on the motion of a step
  /// then grows with the length of the step.
  void moves(int row, double rate) {
    rate_[std::size_t(row)] += rate;
    retardation_time_[std::size_t(row)] = lasting;
  }
  int rows() const { return int(delta_.size()); }

  void clear();
  /// Copies rows, blocks and delta_free into the problem (W is not touched).
  void finish();

 private:
  ConstraintProblem& problem_;
  const std::vector<Body*>& bodies_;
  static constexpr double lasting = 10;  ///< s: time constant of a rate that does not decay
  std::vector<double> delta_, rate_, retardation_time_;
  std::vector<Block> blocks_;
  int owner_ = -1;
};

/// lambda of the rows after the solve.
struct ConstraintSolution {
  const ConstraintProblem& problem;
  const double* lambda;  ///< N
  const double* delta;   ///< m, W lambda + delta_free
};

/// Unique id of a row: the component's `order` in the document, and a key of the component's choice (44 bits).
inline std::uint64_t row_id(const Component& c, std::uint64_t key) {
  return (std::uint64_t(c.order) << 44) ^ (key & ((std::uint64_t(1) << 44) - 1));
}
/// The `order` from which an id was made.
inline int owner_of(std::uint64_t id) { return int(id >> 44); }

class Simulation;
struct StepReport;

class Constraint : public Component {
 public:
  static constexpr std::string_view kind_name = "constraint";

  /// Called once, after all components are prepared. Creates what connects bodies. May report errors.
  virtual void connect(PrepareContext&, Simulation&) {}
  /// Called once, after every component is connected: finds the channels of others that it reads. What it reads in a
  /// step are the values that were published at the end of the step before. May report errors.
  virtual void find_channels(PrepareContext&, const Simulation&) {}
  /// Called when the scene has settled (<settle>), before the exercise begins, and again after every reset. May report
  /// errors.
  virtual void settled(PrepareContext&) {}
  /// Stage 2, collision: finds what is close. The free motion of tools is known. Default: nothing.
  virtual void detect(const StepContext&) {}
  /// Stage 3: adds rows.
  virtual void build(const StepContext& context, ConstraintBuilder& builder) = 0;
  /// Whether build() ever adds a row. False if it acts only between the steps (a flow network, a source).
  virtual bool adds_rows() const { return true; }
  /// After stage 5: reads its lambda, changes its state (wear, failure) and emits events.
  virtual void finish(const StepContext&, const ConstraintSolution&) {}
  /// Stage 6: adds its contacts to the report.
  virtual void report(StepReport&) const {}
  /// After a step: appends the frames that its loaded friction contacts will have `steps` steps later. Each belongs to
  /// a block with LawKind::friction of the last step; others are ignored. Default: none are predicted.
  virtual void predict_frames(double /*steps*/, std::vector<ContactFrame>&) const {}
  /// After a step: appends what is near the tools of the hands, where contacts may be found between steps. Default:
  /// nothing.
  virtual void find_patches(std::vector<PatchCandidate>&) const {}
  /// After a step: adds the cost of its search and its rows. Default: the rows of the last step and no search.
  virtual void estimate_cost(CostCounts&) const {}
  virtual void reset() {}
  virtual void append_state(std::vector<double>&) const {}
};

}  // namespace insula
