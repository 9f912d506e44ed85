// SPDX-License-Identifier: GPL-3.0-or-later
// What a step of a scene will cost: the work of its stages, in counts that do not depend on the machine, times what
// this machine needs for one of each, measured in a fraction of a second. `insula check` tells it; docs/performance.md
// says how good it is.
#pragma once
#include <array>
#include <string>
#include <vector>

#include "core/linalg/compliance_solver.h"
#include "core/sim/report.h"
#include "core/sim/simulation.h"

namespace insula {

/// Of one deformable body and one step.
struct BodyWork {
  std::string id;
  int nodes = 0;
  int elements = 0;  ///< tetrahedra, or triangles of a wall
  bool wall = false;
  bool keeps_tangent = false;  ///< its factor is made anew only now and then
  bool background = false;     ///< ... or beside the steps, in single precision, which then iterate
  double h = 0;
  int rows = 0;  ///< expected
  SolverCost solver;
  double compliance_flops = 0;  ///< of the expected rows
};

struct SceneWork {
  double h = 0;
  std::vector<BodyWork> bodies;
  int surface_vertices = 0;   ///< of all surfaces that move
  int surface_triangles = 0;  ///< of those that something touches: their trees are refitted
  int tissue_vertices = 0;    ///< over pairs of surfaces that may touch, those of both
  int tool_pieces = 0;        ///< over pairs of a tool in use and a surface
  int wall_vertices = 0;      ///< of walls that may meet themselves
  int standing_rows = 0;      ///< there before a hand does anything
  int expected_rows = 0;      ///< with the hands at work, and a clip closed where there are clips
  int max_rows = 0;           ///< with every tool's contacts at their limit
  double expected_sweeps = 0;
  bool newton = false;  ///< allowed where sweeps stall
};

/// Of the compliance of so many rows, each of which reaches the usual part of the factor.
double usual_compliance_flops(double rows, const SolverCost& solver, int nodes);

/// After the simulation has made a step: rows and the compliance's flops are those of the last one.
SceneWork count_work(const Simulation& simulation);

/// Seconds for one of each, on one thread.
struct CostRates {
  double tetrahedron = 0, tetrahedron_force = 0;    ///< with the tangent; without
  double factor_flop = 0, factor_entry = 0;         ///< of one factorisation: t = flops a + entries b
  double solve_entry = 0;                           ///< of one solve
  double compliance_flop = 0, compliance_row2 = 0;  ///< of W of one body; of adding it
  double vertex = 0;                                ///< of a surface, brought up to date
  double sweep_row2 = 0;                            ///< one sweep over one row's row of W
};
/// Takes some tenths of a second.
CostRates measure_rates(const Registry& registry);

struct CostEstimate {
  std::array<double, stage_count> stage_ms{};
  double step_ms = 0;
  double refactor_ms = 0;           ///< more, in a step in which a kept factor is made anew
  std::string most;                 ///< what takes most of it, in words
  std::vector<std::string> advice;  ///< when it is more than the step
};
CostEstimate estimate(const SceneWork& work, const CostRates& rates, int threads);

}  // namespace insula
