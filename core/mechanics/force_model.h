// SPDX-License-Identifier: GPL-3.0-or-later
// Base of every force plugin: mass, force, stiffness and energy of the deformable body that owns it.
#pragma once
#include <utility>
#include <vector>

#include "core/linalg/block_matrix.h"
#include "core/registry/component.h"

namespace insula {

class DeformableBody;
struct StepContext;

/// Which derivative of the force goes into the system matrix.
enum class Tangent {
  exact,   ///< the force's full gradient; may be indefinite (contract tests)
  system,  ///< what the step uses: positive semidefinite, and at least half of the exact one where it is an
           ///< approximation
};

class ForceModel : public Component {
 public:
  static constexpr std::string_view kind_name = "force model";

  /// Called once, when the body's rest shape is known. May report errors, for example that the body has another
  /// topology.
  virtual void attach(PrepareContext&, DeformableBody&) {}
  /// Pairs of nodes of the body that this tangent and the damping couple. They include all blocks that bind() uses.
  virtual void couplings(std::vector<std::pair<int, int>>& pairs, Tangent which) const = 0;
  /// Called once, when the matrix pattern is known. free_of_node: node -> block of `a`, -1 when fixed.
  virtual void bind(const BlockMatrix& a, const std::vector<int>& free_of_node) = 0;
  /// Lumped mass (kg) and Rayleigh mass damping (kg/s), one value a node. Both are added to the present values.
  virtual void add_mass(std::vector<double>&, std::vector<double>&) const {}
  /// force (3 values a node, N) += -dE/dx at positions x (m). If `stiffness` is not null: its blocks += (1 +
  /// stiffness_damping()/h) * d2E/dx2, in the form that `tangent` selects.
  virtual void linearise(const double* x, double* force, BlockMatrix* stiffness, double h, Tangent tangent) = 0;
  /// Whether the model has a force that depends on velocity besides stiffness_damping(). Constant after attach().
  virtual bool has_damping() const { return false; }
  /// Called only if has_damping(). force (3 values a node, N) += the force at positions x (m) and velocities v (m/s)
  /// that is not in linearise(). If `damping` is not null: its blocks += C = -d(force)/dv, N s/m, symmetric and
  /// positive semidefinite. `damping` has the pattern of the matrix of bind(). h: the step, s; a law with internal
  /// variables integrates them implicitly over it. The step solves (M/h^2 + C/h + K) dq = f + C v + M v/h.
  virtual void linearise_damping(const double* /*x*/, const double* /*v*/, double* /*force*/, BlockMatrix* /*damping*/,
                                 double /*h*/) {}
  /// Energy at positions x, J.
  virtual double energy(const double* x) = 0;
  /// Adds the Cauchy stress of the model's elements at positions x (m) to `stress`, Pa, scene frame. `stress` has one
  /// matrix for each tetrahedron of a solid, or for each wall triangle of a shell, in the order of the body. The stress
  /// of a wall is its mean over the thickness, which is that at rest. It contains no damping. Returns false, and does
  /// nothing, if the model has no stress (springs to the surroundings).
  virtual bool add_stress(const double* /*x*/, std::vector<Mat3>& /*stress*/) const { return false; }
  /// Moves the stress-free configuration by u (3 values a node, m) while the rest configuration stays: the linear
  /// strain of u at rest is subtracted from the strain, in force, tangent and energy alike. Calls add up, and reset()
  /// keeps the result. Called between connect and the first step. Returns false, and does nothing, if the model has no
  /// stress-free configuration of its own (springs to the surroundings).
  virtual bool prestrain(const double*) { return false; }
  /// Scales the stress-free configuration in all directions: above 1 tissue swells, below 1 it shrinks. Force, tangent
  /// and energy follow. Called between two steps; reset() keeps the result. Returns false, and does nothing, if the
  /// model cannot swell.
  virtual bool set_natural_stretch(double) { return false; }
  /// Rayleigh stiffness damping, s.
  virtual double stiffness_damping() const { return 0; }
  /// Thickness of the wall that the model represents in a region of a shell, m; 0: none. Used for drawing.
  virtual double wall_thickness(int /*region*/) const { return 0; }
  /// Whether all forces are internal: no force in rigid motion, and forces and moments sum to zero.
  virtual bool internal() const { return true; }
  /// Called after stage 5 of each step, at the body's new positions x (m). Only here may the law change permanently
  /// (tear, yield, wear) and may events be emitted. Returns true if the law has changed; the next step then computes a
  /// new tangent.
  virtual bool finish(const StepContext&, const double* /*x*/) { return false; }
  /// Restores the state before the first step, so it undoes all changes of finish().
  virtual void reset() {}
  /// Appends the state that finish() has changed, for the state's hash.
  virtual void append_state(std::vector<double>&) const {}
};

/// Base of a condition on the support that owns it: the support holds only nodes that satisfy all of its conditions.
class Condition : public Component {
 public:
  static constexpr std::string_view kind_name = "condition";
  /// Clears chosen[i] for the nodes that it excludes, and sets none. Rest positions in metres, scene frame.
  virtual void restrict(PrepareContext&, const std::vector<Vec3>& rest, std::vector<char>& chosen) = 0;
};

/// Base of every support plugin: selects the fixed nodes of the body that owns it.
class Support : public Component {
 public:
  static constexpr std::string_view kind_name = "support";
  /// Sets fixed[i] for the nodes that it fixes. Rest positions in metres, scene frame.
  virtual void fix(PrepareContext&, const std::vector<Vec3>& rest, std::vector<char>& fixed) = 0;
  /// fix() without the nodes that its conditions exclude. If no node is left, this is an error at the support.
  void hold(PrepareContext& context, const std::vector<Vec3>& rest, std::vector<char>& fixed);
};

}  // namespace insula
