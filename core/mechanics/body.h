// SPDX-License-Identifier: GPL-3.0-or-later
// A body of the simulation: generalised position q, velocity v and what its system matrix A answers.
// Degrees of freedom come in blocks of three: a node of a soft body is one block; a rigid body has two
// (translation, rotation vector); a fixed obstacle has none.
#pragma once
#include <array>
#include <cmath>
#include <vector>

#include "core/linalg/body_rows.h"
#include "core/linalg/body_solver.h"
#include "core/mechanics/step_context.h"
#include "core/registry/component.h"

namespace insula {

class Body;
class ConstraintBuilder;
struct ConstraintSolution;
struct StepReport;

/// A point that moves with a body.
struct MaterialPoint {
  Body* body = nullptr;
  int count = 0;                   ///< nodes used (deformable bodies), 0 for rigid and fixed bodies
  int link = 0;                    ///< rigid bodies: which link
  std::array<int, 4> node{};       ///< node indices
  std::array<double, 4> weight{};  ///< sum 1
  Vec3 local = Vec3::Zero();       ///< frame of the link (rigid), scene frame (fixed), m; deformable: a constant
                                   ///< offset added to the weighted nodes, scene frame
};

class Body : public Component {
 public:
  static constexpr std::string_view kind_name = "body";

  int index = -1;  ///< position among the simulation's bodies

  /// Once, after this body and everything it owns are prepared: topology, masses, symbolic factorisation.
  virtual void connect(PrepareContext&) {}

  virtual int blocks() const = 0;  ///< number of 3-blocks of degrees of freedom
  /// Whether it takes part in the step; a rigid body that lies on the tray does not.
  virtual bool active() const { return true; }
  /// Position at the start of the step (current q), scene frame.
  virtual Vec3 position(const MaterialPoint& p) const = 0;
  /// What collision looks ahead along over the step, scene frame. For tools it is the free motion's. For tissue it is
  /// the last step's displacement: what is held springs back in its free motion, step after step, and goes nowhere.
  virtual Vec3 expected_displacement(const MaterialPoint& p) const = 0;
  /// Displacement over the step without any row's force, linearised, scene frame. Valid after free_motion(). What it
  /// costs tissue: a solve, when first asked in a step; not to be asked by two threads.
  virtual Vec3 unforced_displacement(const MaterialPoint& p) const { return expected_displacement(p); }
  /// Whether the point ever moves; what is held does not.
  virtual bool can_move(const MaterialPoint&) const { return true; }
  /// The point's row entries for a direction d: adds d . d(point)/d(q) to the open row.
  virtual void add_row(BodyRows& rows, const MaterialPoint& p, const Vec3& d) const = 0;

  /// Assembles and factorises A, begins the motion.
  virtual void free_motion(const StepContext& context) = 0;
  /// Computes H A^-1 H^T of these rows into the body's own memory; bodies do this in parallel.
  virtual void compute_compliance(const BodyRows&) {}
  /// The same as set-up and two acts in parts, 0 to compliance_parts(act) - 1, in any order and by any thread.
  virtual void begin_compliance(const BodyRows& r) { compute_compliance(r); }
  virtual int compliance_parts(ComplianceAct) const { return 0; }
  virtual void compliance_part(ComplianceAct, int) {}
  /// Adds it into `w` (row-major, leading dimension `stride`), at the rows' numbers; one body after the other.
  virtual void add_compliance(const BodyRows& rows, double* w, int stride) = 0;
  /// Adds H dq of the free motion to delta_free, at the rows' numbers. After their compliance.
  virtual void add_free_motion(const BodyRows& rows, double* delta) const = 0;
  /// Whether add_compliance() and apply() are of the same A. If not, respond() tells what lambda truly does, for defect
  /// correction.
  virtual bool exact() const { return true; }
  /// Then the free motion may be that under the last step's forces of rows (BodySolver::begin_motion). Takes off delta,
  /// by row number, what these do in it.
  virtual void subtract_lagged(const BodyRows&, double* /*delta*/) const {}
  /// Computes what apply() would add to the free motion; bodies do this in parallel.
  virtual void apply_compliance(const BodyRows&, const double* /*lambda*/) {}
  /// Adds it at the rows' numbers.
  virtual void add_applied_compliance(const BodyRows&, double* /*delta*/) const {}
  /// What works in the background may be waited for (same input, same bits) or not (a step is never late). Default: it
  /// may.
  virtual void set_deterministic(bool) {}
  virtual SolverStatus solver_status() const { return {}; }
  /// q += free displacement + A^-1 H^T lambda (less the forces that the free motion is under); v = dq / h.
  virtual void apply(const StepContext& context, const BodyRows& rows, const double* lambda) = 0;
  /// After apply(): adds d(row)/dt at the rows' numbers, m/s. What a hand holds adds nothing: the hand moves it between
  /// steps.
  virtual void add_rate(const BodyRows&, double* /*rate*/) const {}
  /// In what time its shape follows a force there, viscous over elastic modulus, s. After the first free motion.
  virtual double retardation_time(const MaterialPoint&) const { return 0; }
  /// Rows of its own (stops of a hinge, a tool's pull), after those of the constraints; bodies in document order.
  virtual void build(const StepContext&, ConstraintBuilder&) {}
  /// After stage 5: reads the lambda of its rows.
  virtual void finish(const StepContext&, const ConstraintSolution&) {}
  virtual void reset() = 0;
  /// Kinetic plus elastic energy, J.
  virtual double energy() const = 0;
  /// Whether its state is made of numbers.
  virtual bool finite() const { return std::isfinite(energy()); }
  /// Appends the state that a hash or a recorder needs.
  virtual void append_state(std::vector<double>& out) const = 0;

  BodyRows rows;  ///< rebuilt every step
};

}  // namespace insula
