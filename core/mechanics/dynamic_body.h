// SPDX-License-Identifier: GPL-3.0-or-later
// The step's interface to a body that moves: generalised position q, velocity v, and products with A^-1.
// The simulation calls these functions in the order in which they are declared.
#pragma once
#include <cmath>
#include <vector>

#include "core/mechanics/body.h"
#include "core/mechanics/step_context.h"

namespace insula {

class BodySolver;
class ConstraintBuilder;
struct ConstraintSolution;

class DynamicBody : public Body {
 public:
  using Body::Body;

  /// Whether it takes part in the step. A rigid body on the tray does not.
  virtual bool active() const { return true; }
  /// Assembles and factorises A, and begins the motion.
  virtual void free_motion(const StepContext& context) = 0;
  /// Adds its own rows (stops of a hinge, the pull of a tool) after those of the constraints, in document order.
  virtual void build(const StepContext&, ConstraintBuilder&) {}
  /// The solver of its system. The parts of the compliance are computed between the next two functions. Null if the
  /// body computes its response without a solver.
  virtual BodySolver* solver() { return nullptr; }
  /// Receives the rows of the step. Called for bodies in parallel.
  virtual void begin_compliance(const BodyRows&) {}
  /// Adds H A^-1 H^T to `w` (row-major, leading dimension `stride`) and H dq of the free motion to `delta_free`, at the
  /// row numbers. Called for one body after the other.
  virtual void add_response(const BodyRows& rows, double* w, int stride, double* delta_free) = 0;
  /// q += free displacement + A^-1 H^T (lambda - lagged forces of the free motion), and v = dq / h. Called for bodies
  /// in parallel.
  virtual void apply(const StepContext& context, const BodyRows& rows, const double* lambda) = 0;
  /// Adds d(row)/dt at the row numbers, m/s. A body in a hand adds nothing, since the hand moves it between steps.
  virtual void add_rate(const BodyRows&, double* /*rate*/) const {}
  /// Reads the lambda of its rows.
  virtual void finish(const StepContext&, const ConstraintSolution&) {}
  /// Kinetic plus elastic energy, J.
  virtual double energy() const = 0;
  /// Whether its state is finite.
  virtual bool finite() const { return std::isfinite(energy()); }
  /// Appends the state that a hash or a recorder needs.
  virtual void append_state(std::vector<double>& out) const = 0;
  virtual void reset() = 0;
};

}  // namespace insula
