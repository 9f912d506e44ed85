// SPDX-License-Identifier: GPL-3.0-or-later
// One tick of the haptic loop for both hands in one problem (Dequidt, Coevoet, Thines, Duriez 2015, equation 7).
#pragma once
#include <algorithm>
#include <array>
#include <cstdint>
#include <vector>

#include "core/constraint/problem.h"
#include "core/constraint/solve.h"
#include "haptic_server/force_crossfade.h"
#include "haptic_server/substep_correction.h"

namespace insula {

inline constexpr int servo_max_rows = 240;

struct ServoSettings {
  int max_sweeps = 50;
  /// Bound of sweeps times rows squared, so that a tick stays within its millisecond for any number of rows.
  double max_operations = 1.2e6;
  double tolerance_m = 1e-9;
  bool conjugate = false;  ///< sweeps use conjugate directions (core/constraint/solve.h)
  /// If a few sweeps do not reach the tolerance, one Newton step with at most this many unknowns follows
  /// (core/constraint/newton.h). 200 unknowns take 0.4 ms on the machine of docs/haptic-truth.md. 0: only sweeps.
  int newton_unknowns = 0;
  /// A device farther than this from the problem's pose is outside the linearisation and gets no force.
  double max_displacement_m = 0.03;
  double max_rotation_rad = 0.8;
  /// Corrections beyond equation 7, all off by default.
  SubstepCorrectionSettings substep;
  /// Cross-fade to the force of a new problem; off by default.
  ForceCrossfadeSettings force_crossfade;
  /// All corrections, with the settings of docs/haptic-truth.md.
  static ServoSettings beyond_equation_7() {
    ServoSettings s;
    s.substep = {.substep_compliance = true,
                 .extrapolate_tissue = true,
                 .incremental_slip = true,
                 .eliminate_welds = true,
                 .extrapolate_frames = true,
                 .find_contacts = true,
                 .predict_failure = true,
                 .reduced_dynamics = true};
    s.force_crossfade.within_s = 0.005;
    s.force_crossfade.share_per_s = 14;
    s.conjugate = true;
    s.newton_unknowns = 200;
    return s;
  }
};

/// Device poses at the tick; a hand that is not connected counts as at rest at the problem's pose.
struct ServoInput {
  std::array<Pose, 2> device;
  std::array<bool, 2> connected{false, false};
  double dt_s = 1e-3;  ///< since the last tick
};

/// Result for one hand. Force and torque (about the device's origin) act on the hand, scene frame.
struct ServoHand {
  bool valid = false;  ///< a tool of this hand is in the problem, everything is finite and in range
  Vec3 force = Vec3::Zero();
  Vec3 torque = Vec3::Zero();
  Pose tool;  ///< predicted tool pose
};

struct ServoResult {
  bool solved = false;  ///< there was a problem, and this tick has solved it
  std::array<ServoHand, 2> hand;
  SolveStats stats;
  int rows = 0;
};

/// The servo's state is its last solution. tick uses only this and its arguments.
///   d_t         = displacement(device pose of the problem, device pose now)        6 components, tool by tool
///   delta_free' = delta_free + sum_t H_t G_t d_t
///   lambda      = solve(problem with delta_free', warm start)
///   x_tool      = x_free + G d + A_tool^-1 H^T lambda
///   force       = stiffness * displacement(device pose now, x_tool)
/// Neither tick nor set_problem allocates, locks, waits or throws.
class Servo {
 public:
  explicit Servo(const ServoSettings& settings = {});
  Servo(const Servo&) = delete;
  Servo& operator=(const Servo&) = delete;

  /// Sets the problem to solve, which must not change until the next call; nullptr: none. offset: tool frame relative
  /// to the device's pose, tool by tool in the problem's order (tool = device * offset). The warm start comes from the
  /// last solution by block id. A new block starts from the problem's lambda. A problem with more than servo_max_rows
  /// rows counts as none. age_s: time since its device poses, used by the corrections beyond equation 7.
  void set_problem(const ConstraintProblem* problem, const std::array<Pose, 2>& offset = {}, double age_s = 0) noexcept;
  /// The problem that is solved: the one that was set, or the same without the weld rows of grasped bodies and without
  /// the rows of surface patches, whose contacts are added in each tick.
  const ConstraintProblem* problem() const { return problem_; }

  ServoResult tick(const ServoInput& input) noexcept;

  /// Solution of the last tick (or the warm start, before it); the first problem()->rows values count.
  const std::vector<double>& lambda() const { return workspace_.lambda; }
  /// Drops the last solution. The next problem starts from its own lambda.
  void reset() noexcept;

 private:
  struct Known {
    std::uint64_t id;
    int row;
    LawKind law;
  };
  /// Poses of the devices at a tick, tool by tool.
  struct TickHands {
    std::array<Vec6, 2> moved{Vec6::Zero(), Vec6::Zero()};  ///< displacement since the problem's poses
    std::array<Pose, 2> device;                             ///< poses with the tool's offset applied
    std::array<bool, 2> in_range{true, true};
  };
  void remember_solution() noexcept;
  std::size_t tool_count() const noexcept { return std::min<std::size_t>(problem_->tools.size(), 2); }
  void place_devices(const ServoInput& input, TickHands& hands) noexcept;
  SolveStats solve_tick(const ServoInput& input, const TickHands& hands) noexcept;
  void find_forces(const ServoInput& input, const TickHands& hands, ServoResult& result) const noexcept;
  void drop_solution_that_is_not_finite(ServoResult& result) noexcept;

  ServoSettings settings_;
  const ConstraintProblem* problem_ = nullptr;
  std::array<Pose, 2> offset_;
  PatchContacts patch_contacts_;
  WeldElimination weld_elimination_;
  SubstepCorrection substep_;
  void force_crossfade(ServoResult& result, double dt) noexcept;
  std::array<ForceCrossfade, 2> force_crossfade_;
  bool fresh_problem_ = false;
  bool fresh_contacts_ = false;  ///< contacts took over the force of others in this tick
  double newton_bound_ = 0;      ///< of a value of lambda in this problem
  SolveWorkspace workspace_;
  std::vector<double> delta_free_;
  std::vector<double> last_lambda_;
  std::vector<Known> known_;  ///< blocks of last_lambda_, by id; room for servo_max_rows
  std::size_t known_count_ = 0;
};

}  // namespace insula
