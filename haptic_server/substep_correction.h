// SPDX-License-Identifier: GPL-3.0-or-later
// Response of tissue within a tick, computed from its response over a whole step.
//
// A step of length h solves (M/h^2 + C/h + K) dq = ..., so its W is the compliance of tissue over that time. Tissue is
// viscous, C = beta K. In a tick of dt it yields less, and it continues its motion. Without inertia, implicit Euler
// over dt is exactly, row by row,
//   du          = a dt u' + s W_tissue (lambda - lambda of the tick before),   a = beta / (beta + dt)
//   s           = dt / (beta + dt) * (h + beta) / h                            1 for dt = h, or where nothing is
//   viscous delta       = delta of the tick before + H_tool d(tool) + du + W_tool (lambda - ...)
// with u' the rate of the row's gap due to everything except the hands' tools. The first tick of a problem starts from
// the end of its step.
#pragma once
#include <algorithm>
#include <array>
#include <span>
#include <vector>

#include "core/constraint/problem.h"
#include "core/haptics/weld_elimination.h"
#include "haptic_server/contact_frame_extrapolation.h"
#include "haptic_server/grasping_tool.h"
#include "haptic_server/patch_contacts.h"
#include "haptic_server/predicted_failure.h"
#include "haptic_server/reduced_dynamics.h"

namespace insula {

struct SubstepCorrectionSettings {
  bool substep_compliance = false;  ///< W of the tick instead of that of the step
  bool extrapolate_tissue = false;  ///< tissue continues at its rate
  bool incremental_slip = false;    ///< friction opposes the slip of the tick instead of that since the step began
  bool eliminate_welds = false;     ///< a grasped body is one with its tool, with the inertia for a tick
  bool extrapolate_frames = false;  ///< contact directions continue to rotate with the tool
  bool find_contacts = false;       ///< contacts are found anew in each tick, where the problem has surface patches
  bool predict_failure = false;     ///< fibres part at the tick in which they are cut or torn
  bool reduced_dynamics = false;    ///< tissue has inertia, where the problem has a reduced model; needs the first two
  bool any() const {
    return substep_compliance || extrapolate_tissue || incremental_slip || eliminate_welds || extrapolate_frames ||
           find_contacts || predict_failure;
  }
};

/// State of the rows between ticks. Allocates only in its constructor.
class SubstepCorrection {
 public:
  SubstepCorrection(const SubstepCorrectionSettings& settings, int max_rows);

  /// Starts a problem from the end of its step, `age_s` ago, without the servo's last solution. `patches`: contacts
  /// that were made from the same message; null: none.
  void begin(const ConstraintProblem& problem, const std::array<GraspedBody, 2>& grasped, double age_s,
             PatchContacts* patches = nullptr) noexcept;
  /// Makes the next problem independent of the last one. Grasped bodies begin at their poses in that problem.
  void reset() noexcept {
    for (GraspingTool& tool : grasping_) tool.lose();
    failure_.reset();
  }
  /// The problem of the next tick, `dt_s` after the last one; the first one covers the problem's age instead. `moved`:
  /// displacement of the devices since the problem's poses, tool by tool. The first rows are those of the problem.
  /// Those of contacts on patches follow, and lambda of these is their warm start.
  const ConstraintProblem& next(double dt_s, const std::array<Vec6, 2>& moved) noexcept;
  /// Takes the solution of that problem.
  void solved(std::span<const double> lambda, std::span<const double> delta) noexcept;
  /// Whether rows of the tool let go in the last tick, so that the change of its force is no error (PredictedFailure).
  bool released(std::size_t tool) const { return (released_ >> tool & 1U) != 0; }
  /// The tool after the tick if it grasps a body, else null.
  const GraspingTool* grasping(std::size_t tool) const { return grasped_[tool].any ? &grasping_[tool] : nullptr; }
  /// Force and moment of all rows on a tool after the tick, about its origin, N and N m.
  const Vec6& pushed(std::size_t tool) const { return push_[tool]; }
  /// The present rows of the tool in this tick.
  const ContactFrameExtrapolation::Jacobian& jacobian(std::size_t tool) const { return extrapolation_.jacobian(tool); }

 private:
  void find_tool_coupled_rows() noexcept;
  void begin_dynamics() noexcept;
  void add_modes(double* w, std::span<const double> weight) noexcept;
  void scale_compliance(double dt) noexcept;
  Vec6 push(std::size_t tool, std::span<const double> lambda) const noexcept;
  const ConstraintProblem& with_patches(const std::array<Vec6, 2>& moved) noexcept;
  Vec6 patch_push(std::size_t tool) const noexcept { return patches_ ? patches_->push(tool) : Vec6(Vec6::Zero()); }
  /// A tool's compliance in the tick.
  const Mat6& give(std::size_t tool) const {
    return grasped_[tool].any ? grasping_[tool].give() : step_->tools[tool].compliance;
  }
  std::size_t tools() const { return std::min<std::size_t>(step_->tools.size(), 2); }
  /// The row's gap at the start of the tick.
  double start(std::size_t i) const { return slips_[i] ? 0.0 : gap_[i]; }

  SubstepCorrectionSettings settings_;
  ContactFrameExtrapolation extrapolation_;
  const ConstraintProblem* step_ = nullptr;
  PatchContacts* patches_ = nullptr;
  ConstraintProblem tick_;  ///< W and delta_free of the tick
  PredictedFailure failure_;
  ReducedDynamics dynamics_;
  AlignedVector<double> w_residual_;  ///< W of the step without that of the modes, as W
  std::vector<double> gap_, rate_, known_, share_;
  std::vector<char> slips_;           ///< tangent rows, and rigid-plastic ones
  std::vector<int> touching_;         ///< rows that touch a body
  std::vector<int> tool_coupled_;     ///< rows in which a tool has a part
  std::array<Vec6, 2> moved_, went_;  ///< of the free tools, since the problem and in the tick
  std::array<Vec6, 2> push_;          ///< H_tool^T known, and that of the patches' contacts
  std::array<GraspedBody, 2> grasped_;
  std::array<GraspingTool, 2> grasping_;
  unsigned released_ = 0;
  double age_ = 0, dt_ = 0, compliance_dt_ = 0;
  bool first_ = true, second_ = false;  ///< whether the next tick is the first or second of its problem
};

}  // namespace insula
