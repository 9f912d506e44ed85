// SPDX-License-Identifier: GPL-3.0-or-later
// Adds the surface patches near the tools to a step's problem (core/constraint/surface_patch.h), so that the servo can
// find contacts between steps, and the reduced dynamic model of their bodies.
//
// Constraints offer triangles (Constraint::find_patches). The nearest ones are taken until the rows of their vertices
// fill the problem. The compliance of these rows comes from the factor of the step. It is computed in the solver's
// second set of rows, so the step's own bits do not depend on it. Bodies whose solver has no such set get no patch.
#pragma once
#include <vector>

#include "core/haptics/reduced_model_builder.h"
#include "core/sim/simulation.h"

namespace insula {

class DeformableBody;

class SurfacePatchBuilder {
 public:
  /// The problem of the simulation's last step with patches: the simulation's own problem if nothing is near a tool.
  /// Patches get the rows that are free up to `max_rows`, or those of least_vertices; less if rows at the tools need
  /// the room. Valid until the next call or step. Not thread-safe with the step.
  const ConstraintProblem& operator()(const Simulation& simulation, int max_rows);

  /// Computes the modes of the bodies near the tools, for the next problem. Call it when a problem has been sent,
  /// before the next step. Without it, problems have no reduced model.
  void compute_modes();

  static constexpr int least_vertices = 24, most_vertices = 40, most_fixed_vertices = 96;

 private:
  struct Chosen {
    std::size_t candidate;
    int triangle;
    double clear_m;
  };
  struct Vertex {
    const Surface* surface;
    int vertex;
  };
  bool usable(const PatchCandidate& candidate) const;
  int index_of(const Surface& surface, int vertex) const;
  void choose(int moving_vertices);
  void add_vertices(int first_row);
  void add_patch(const ConstraintProblem& step, std::size_t candidate);
  void extend(const ConstraintProblem& step);
  void add_compliance(const ConstraintProblem& step);

  ConstraintProblem extended_;
  SurfacePatches patches_;
  std::vector<PatchCandidate> candidates_;
  std::vector<Chosen> order_, chosen_;
  std::vector<Vertex> vertices_;
  std::vector<DeformableBody*> bodies_;
  ReducedModelBuilder reduced_;
  std::vector<ReducedBasis::Loaded> loaded_;
  BodyRows body_rows_, vertex_rows_;
  std::vector<double> w_, own_;  ///< by bodies with patches: W; its diagonal by one body
  std::vector<char> at_tool_;
};

}  // namespace insula
