// SPDX-License-Identifier: GPL-3.0-or-later
// What the step needs of a body that moves: generalised position q, velocity v, and the answers of its system matrix A.
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

  /// Whether it takes part in the step; a rigid body that lies on the tray does not.
  virtual bool active() const { return true; }
  /// Assembles and factorises A, begins the motion.
  virtual void free_motion(const StepContext& context) = 0;
  /// Rows of its own (stops of a hinge, a tool's pull), after those of the constraints; bodies in document order.
  virtual void build(const StepContext&, ConstraintBuilder&) {}
  /// The solver of its system; its parts of the compliance are computed between the next two functions. Null: the body
  /// answers its rows by itself.
  virtual BodySolver* solver() { return nullptr; }
  /// Takes the rows of the step; bodies do this in parallel.
  virtual void begin_compliance(const BodyRows&) {}
  /// Adds H A^-1 H^T to `w` (row-major, leading dimension `stride`) and H dq of the free motion to `delta_free`, at the
  /// rows' numbers; one body after the other.
  virtual void add_response(const BodyRows& rows, double* w, int stride, double* delta_free) = 0;
  /// q += free displacement + A^-1 H^T lambda (less the forces that the free motion is under); v = dq / h. Bodies do
  /// this in parallel.
  virtual void apply(const StepContext& context, const BodyRows& rows, const double* lambda) = 0;
  /// Adds d(row)/dt at the rows' numbers, m/s. What a hand holds adds nothing: the hand moves it between steps.
  virtual void add_rate(const BodyRows&, double* /*rate*/) const {}
  /// Reads the lambda of its rows.
  virtual void finish(const StepContext&, const ConstraintSolution&) {}
  /// Kinetic plus elastic energy, J.
  virtual double energy() const = 0;
  /// Whether its state is made of numbers.
  virtual bool finite() const { return std::isfinite(energy()); }
  /// Appends the state that a hash or a recorder needs.
  virtual void append_state(std::vector<double>& out) const = 0;
  virtual void reset() = 0;
};

}  // namespace insula
