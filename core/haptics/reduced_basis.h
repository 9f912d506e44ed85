// SPDX-License-Identifier: GPL-3.0-or-later
// The modes of one body for a reduced dynamic model (core/constraint/reduced_model.h).
//
// The modes span the block Krylov space of the loads B near the tools, with the factor of the step:
//   span{A^-1 B, A^-1 M A^-1 B, ...}
// The reduced body then has the first moments of the whole body's answer to these loads, about the frequency of the
// step (Bai, Su 2005, doi:10.1137/040605552). Modes of the whole body, or of a part of it that is held at an interface
// (Craig, Bampton 1968), need many more for a load at a point. Modes of a nonlinear material (Barbic, James 2008) are
// made before the start, when it is not known where a tool will touch.
//
// B has, for each tool, loads on the vertices near it that are uniform or linear in their position. The ones with the
// largest compliance are taken.
#pragma once
#include <span>
#include <vector>

#include "core/constraint/problem.h"
#include "core/mechanics/deformable_body.h"

namespace insula {

class ReducedBasis {
 public:
  /// More of either changes no error of docs/haptic-truth.md by a tenth.
  struct Size {
    int loads_of_tool = 3;
    int levels = 2;  ///< powers of A^-1 M, from 0 on
  };
  explicit ReducedBasis(Size size) : size_(size) {}
  ReducedBasis() : ReducedBasis(Size{}) {}
  /// A vertex that a tool may touch. It has three rows.
  struct Loaded {
    MaterialPoint point;
    int row = 0;   ///< first of its rows, in W
    int tool = 0;  ///< that may touch it
  };
  /// Computes the modes, with the factor of the last step. Call it between two steps. `w`: compliance of the rows,
  /// `stride` numbers a row.
  void compute(const DeformableBody& body, BodySolver& solver, std::span<const Loaded> loaded, const double* w,
               int stride);
  void clear() { modes_.clear(); }
  bool empty() const { return modes_.empty(); }

  /// Takes the body's velocity and inertia at the end of a step. Call it once after each step.
  void observe(const DeformableBody& body);
  /// Adds the modes to a problem, with the participations of the body's rows. `compliance`: of each of the problem's
  /// rows by the body alone, m/N.
  void add(const DeformableBody& body, const BodyRows& rows, std::span<const double> compliance,
           ConstraintProblem& problem) const;

 private:
  using Columns = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic>;
  struct Damping {
    double of_mass_s = 0, retardation_s = 0;
  };
  void add_loads(const DeformableBody& body, std::span<const Loaded> loaded, const double* w, int stride, int tool);
  void find_modes(const DeformableBody& body, double h);

  Size size_;
  Columns x_, ax_;       ///< Krylov vectors, and A times them; 3 values a free node
  int columns_ = 0;      ///< of these
  Columns v_, av_, mv_;  ///< modes V, A V, M V
  std::vector<ReducedModel::Mode> modes_;
  std::vector<Damping> damping_;
  VecX mass_;                 ///< of the free values, kg
  VecX momentum_, velocity_;  ///< V^T M v at the end of the last step; v of the free nodes
};

}  // namespace insula
