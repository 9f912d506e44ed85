// SPDX-License-Identifier: GPL-3.0-or-later
// The constraint problem of one step as a value: all that `solve` needs.
//   delta = W lambda + delta_free          delta in metres (or rad), lambda in newtons (or N m)
// The same value is solved by the engine once a step and by the haptic server every millisecond
// (Dequidt, Coevoet, Thines, Duriez 2015, equations 5 to 7).
#pragma once
#include <vector>

#include "core/base/math.h"
#include "core/constraint/aligned.h"
#include "core/constraint/block.h"
#include "core/constraint/reduced_model.h"
#include "core/constraint/surface_patch.h"

namespace insula {

/// How the free pose of a hand-held tool follows the device, and the compliance of the tool.
struct ToolCoupling {
  int hand = 0;  ///< 0 left, 1 right
  Pose device;   ///< device pose for which the problem was built, with the tool's offset applied
  Vec3 swept_displacement = Vec3::Zero();  ///< displacement of the device in the step that ended at `device`, m
  Pose free;                               ///< the tool's free pose at the end of the step
  Mat6 gain = Mat6::Identity();            ///< d(free displacement)/d(device displacement)
  Mat6 compliance = Mat6::Zero();          ///< A_tool^-1, (m, rad) per (N, N m)
  Mat6 stiffness = Mat6::Zero();  ///< coupling spring; force on the hand = stiffness * displacement(device, tool)
};

/// A hand-held tool in the problem, with its part in the rows.
struct ToolTerms : ToolCoupling {
  Eigen::Matrix<double, Eigen::Dynamic, 6, Eigen::RowMajor> jacobian;  ///< H_tool, rows x 6
  ToolCoupling& coupling() { return *this; }                           ///< everything except the Jacobian
};

struct ConstraintProblem {
  int rows = 0;
  int stride = 0;                  ///< leading dimension of w, >= rows, a multiple of 8
  AlignedVector<double> w;         ///< W, symmetric, rows x stride, row-major; padding is zero
  std::vector<double> delta_free;  ///< rows
  std::vector<double> lambda;      ///< warm start, rows
  // Extrapolation of the solution after the step, for use between steps (in the servo).
  double step_s = 0;                    ///< length h of the step for which W holds; 0: unknown
  double prediction_horizon_steps = 0;  ///< time from the poses to the moment for which the contacts' directions hold,
                                        ///< in steps; the tools move on as in the step
  std::vector<double>
      rate;  ///< rows: rate of delta at the end of the step due to everything except the hands' tools, m/s
  std::vector<double>
      retardation_time;  ///< rows: time constant of the tissue under the row, viscous over elastic modulus, s; 0: none
  std::vector<Block> blocks;     ///< in row order, covering every row once
  std::vector<ToolTerms> tools;  ///< at most two
  SurfacePatches patches;        ///< for use between steps; empty in the engine's own problem
  ReducedModel reduced;          ///< the same

  double w_at(int i, int j) const { return w[std::size_t(i) * stride + j]; }
  /// Sets the number of rows, zeroes W and all values of rows, and removes the reduced model. Keeps capacity.
  void resize(int n);
};

}  // namespace insula
