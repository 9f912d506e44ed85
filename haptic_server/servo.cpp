// SPDX-License-Identifier: GPL-3.0-or-later
// The haptic tick.
#include "haptic_server/servo.h"

#include <algorithm>
#include <cmath>

#include "core/linalg/kernels.h"

namespace insula {
namespace {

constexpr double most_growth = 100;  // of the largest force between steps, from 1 N or more

// Products with the tall Jacobians are spelled out so that nothing can be allocated.
template <class Jacobian>
void add_product(const Jacobian& h, const Vec6& x, std::vector<double>& y, int rows) {
  for (int i = 0; i < rows; ++i) {
    double sum = 0;
    for (int c = 0; c < 6; ++c) sum += h(i, c) * x[c];
    y[std::size_t(i)] += sum;
  }
}

template <class Jacobian>
Vec6 transposed_product(const Jacobian& h, const std::vector<double>& lambda, int rows) {
  Vec6 sum = Vec6::Zero();
  for (int i = 0; i < rows; ++i)
    for (int c = 0; c < 6; ++c) sum[c] += h(i, c) * lambda[std::size_t(i)];
  return sum;
}

bool finite(const Vec6& v) {
  for (int i = 0; i < 6; ++i)
    if (!std::isfinite(v[i])) return false;
  return true;
}

}  // namespace

Servo::Servo(const ServoSettings& settings)
    : settings_(settings),
      patch_contacts_(settings.substep.find_contacts ? servo_max_rows : 0),
      weld_elimination_(settings.substep.eliminate_welds ? servo_max_rows : 0),
      substep_(settings.substep, servo_max_rows) {
  workspace_.reserve(servo_max_rows, settings.newton_unknowns > 0);
  kernels();  // chosen here once instead of at the first tick
  delta_free_.assign(servo_max_rows, 0.0);
  last_lambda_.assign(servo_max_rows, 0.0);
  known_.resize(servo_max_rows);
}

void Servo::reset() noexcept {
  known_count_ = 0;
  force_crossfade_ = {};
  substep_.reset();
  patch_contacts_.reset();
}

void Servo::force_crossfade(ServoResult& result, double dt) noexcept {
  std::array<bool, 2> released{};  // hand by hand
  for (std::size_t t = 0; t < tool_count(); ++t)
    released[std::size_t(problem_->tools[t].hand & 1)] = substep_.released(t);
  for (std::size_t i = 0; i < 2; ++i) {
    ServoHand& hand = result.hand[i];
    if (!hand.valid) {
      force_crossfade_[i].lost();
      continue;
    }
    Vec6 now;
    now << hand.force, hand.torque;
    const bool fresh = (fresh_problem_ || fresh_contacts_) && !released[i];
    now = force_crossfade_[i](settings_.force_crossfade, fresh, now, dt);
    hand.force = now.head<3>();
    hand.torque = now.tail<3>();
  }
  fresh_problem_ = fresh_contacts_ = false;
}

void Servo::remember_solution() noexcept {
  if (!problem_) return;  // keeps the solution of the last problem
  known_count_ = 0;
  for (const Block& b : problem_->blocks) known_[known_count_++] = {b.id, b.row, b.law};
  std::sort(known_.begin(), known_.begin() + std::ptrdiff_t(known_count_),
            [](const Known& a, const Known& b) { return a.id < b.id; });
  std::copy_n(workspace_.lambda.begin(), problem_->rows, last_lambda_.begin());
}

void Servo::set_problem(const ConstraintProblem* problem, const std::array<Pose, 2>& offset, double age_s) noexcept {
  // The old problem's memory may change after this call, so the necessary parts are copied now.
  remember_solution();
  const bool fits = problem && problem->rows <= servo_max_rows && problem->blocks.size() <= std::size_t(servo_max_rows);
  problem_ = fits ? problem : nullptr;
  if (!problem_) return substep_.reset();
  offset_ = offset;
  fresh_problem_ = true;
  const bool patches = settings_.substep.find_contacts && !problem->patches.empty();
  if (settings_.substep.find_contacts) problem_ = &patch_contacts_.begin(*problem);
  if (settings_.substep.eliminate_welds) problem_ = &weld_elimination_.eliminate(*problem_);
  if (patches) patch_contacts_.couple(*problem_);
  if (settings_.substep.any())
    substep_.begin(*problem_, weld_elimination_.grasped(), age_s, patches ? &patch_contacts_ : nullptr);
  workspace_.lambda.resize(std::size_t(problem_->rows));  // within its capacity
  newton_bound_ = 1;
  for (const double x : problem_->lambda) newton_bound_ = std::max(newton_bound_, std::abs(x));
  newton_bound_ *= most_growth;
  const auto known_end = known_.begin() + std::ptrdiff_t(known_count_);
  for (const Block& b : problem_->blocks) {
    const auto found =
        std::lower_bound(known_.begin(), known_end, b.id, [](const Known& k, std::uint64_t id) { return k.id < id; });
    const bool same = found != known_end && found->id == b.id && found->law == b.law;
    for (int k = 0; k < b.rows(); ++k) {
      double value = same ? last_lambda_[std::size_t(found->row + k)] : problem_->lambda[std::size_t(b.row + k)];
      if (!std::isfinite(value)) value = 0;
      workspace_.lambda[std::size_t(b.row + k)] = value;
    }
  }
}

void Servo::place_devices(const ServoInput& input, TickHands& hands) noexcept {
  const ConstraintProblem& p = *problem_;
  std::copy_n(p.delta_free.begin(), p.rows, delta_free_.begin());
  for (std::size_t t = 0; t < tool_count(); ++t) {
    const ToolTerms& tool = p.tools[t];
    hands.device[t] = tool.device;
    const std::size_t hand = std::size_t(tool.hand & 1);
    if (!input.connected[hand]) continue;
    hands.device[t].p = input.device[hand].apply(offset_[t].p);
    hands.device[t].q = input.device[hand].q * offset_[t].q;
    const Vec6 d = displacement(tool.device, hands.device[t]);
    hands.in_range[t] = finite(d) && d.head<3>().norm() <= settings_.max_displacement_m &&
                        d.tail<3>().norm() <= settings_.max_rotation_rad;
    if (!hands.in_range[t]) {
      hands.device[t] = tool.device;  // the other hand continues
      continue;
    }
    hands.moved[t] = d;
    if (!settings_.substep.any()) add_product(tool.jacobian, tool.gain * d, delta_free_, p.rows);
  }
}

SolveStats Servo::solve_tick(const ServoInput& input, const TickHands& hands) noexcept {
  const int n = problem_->rows;
  SolveSettings s;
  s.tolerance_m = settings_.tolerance_m;
  s.conjugate = settings_.conjugate;
  s.max_newton = settings_.newton_unknowns > 0 ? 1 : 0;
  s.newton_soon = true;
  s.newton_unknowns = settings_.newton_unknowns;
  s.newton_sweeps = 0;
  s.newton_bound = newton_bound_;
  s.max_sweeps =
      int(std::clamp(settings_.max_operations / std::max(1.0, double(n) * n), 1.0, double(settings_.max_sweeps)));
  if (!settings_.substep.any())
    return solve(*problem_, std::span<const double>(delta_free_.data(), std::size_t(n)), s, workspace_);
  const ConstraintProblem& tick = substep_.next(input.dt_s, hands.moved);
  // The contacts that this tick has found follow the problem's own rows.
  workspace_.lambda.resize(std::size_t(tick.rows));  // within its capacity
  std::copy(tick.lambda.begin() + n, tick.lambda.end(), workspace_.lambda.begin() + n);
  const SolveStats stats = solve(tick, tick.delta_free, s, workspace_);
  substep_.solved(workspace_.lambda, workspace_.delta);
  if (tick.rows > n) fresh_contacts_ = patch_contacts_.exchanged();
  return stats;
}

void Servo::find_forces(const ServoInput& input, const TickHands& hands, ServoResult& result) const noexcept {
  const bool in_ticks = settings_.substep.any();
  for (std::size_t t = 0; t < tool_count(); ++t) {
    const ToolTerms& tool = problem_->tools[t];
    const std::size_t index = std::size_t(tool.hand & 1);
    ServoHand& hand = result.hand[index];
    const Vec6 push =
        in_ticks ? substep_.pushed(t) : transposed_product(tool.jacobian, workspace_.lambda, problem_->rows);
    if (const GraspingTool* grasping = in_ticks ? substep_.grasping(t) : nullptr) hand.tool = grasping->pose();
    else hand.tool = displaced(tool.free, tool.gain * hands.moved[t] + tool.compliance * push);
    const Vec6 wrench = tool.stiffness * displacement(hands.device[t], hand.tool);
    hand.valid = hands.in_range[t] && input.connected[index] && finite(wrench);
    if (!hand.valid) continue;
    hand.force = wrench.head<3>();
    // The wrench acts at the tool's frame; the hand holds the device's.
    hand.torque = wrench.tail<3>() + (hands.device[t].p - input.device[index].p).cross(hand.force);
  }
}

// A solution that is not finite must not be used for warm starts.
void Servo::drop_solution_that_is_not_finite(ServoResult& result) noexcept {
  bool good = true;
  for (int i = 0; i < problem_->rows; ++i) good = good && std::isfinite(workspace_.lambda[std::size_t(i)]);
  if (good) return;
  std::fill_n(workspace_.lambda.begin(), problem_->rows, 0.0);
  for (ServoHand& hand : result.hand) hand.valid = false;
}

ServoResult Servo::tick(const ServoInput& input) noexcept {
  ServoResult result;
  if (!problem_) return result;
  result.rows = problem_->rows;
  TickHands hands;
  place_devices(input, hands);
  // Without rows, a grasping tool still moves.
  if (problem_->rows > 0 || settings_.substep.any()) result.stats = solve_tick(input, hands);
  result.solved = true;
  find_forces(input, hands, result);
  drop_solution_that_is_not_finite(result);
  if (settings_.force_crossfade.within_s > 0) force_crossfade(result, input.dt_s);
  return result;
}

}  // namespace insula
