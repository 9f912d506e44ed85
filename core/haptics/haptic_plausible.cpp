// SPDX-License-Identifier: GPL-3.0-or-later
// What of a haptic_problem_t is believed: magnitudes, laws, blocks, tools.
#include <algorithm>
#include <array>
#include <cmath>

#include "core/haptics/haptic_layout.h"
#include "core/haptics/haptic_update.h"
#include "core/bus/plausible.h"

namespace insula::wire {
namespace {

constexpr double max_delta_m = 1, max_w = 1e4, max_jacobian = 1e3;
constexpr double max_rate = 1e3, max_retardation_time_s = 100, max_frame_rotation_rad = 1, max_prediction_horizon_steps = 100;
constexpr double max_gain = 1e4, max_compliance = 1e8, max_stiffness = 1e8, max_block_compliance = 1e6;

bool header_ok(const ProblemLayout& l, const char*& why) {
  why = "time, step or sequence out of range";
  return l.session >= 0 && l.sequence >= 0 && l.time_us >= 0 && l.pose_time_us >= 0 && l.step_s > 0 && l.step_s <= 1 && l.sim_time_s >= 0 &&
         l.sim_time_s <= 1e9 && l.prediction_horizon_steps >= 0 && l.prediction_horizon_steps <= max_prediction_horizon_steps;
}

bool matrix_ok(const ProblemLayout& l, const char*& why) {
  why = "W not finite or too large";
  std::size_t k = 0;
  for (int i = 0; i < l.rows; ++i)
    for (int j = 0; j <= i; ++j, ++k)
      if (!(std::abs(l.w_at(k)) < max_w)) return false;
  why = "W has a negative diagonal";
  for (int i = 0; i < l.rows; ++i)
    if (l.w_at(std::size_t(i) * std::size_t(i + 3) / 2) < 0) return false;
  why = "delta_free or lambda not finite or too large";
  for (int i = 0; i < l.rows; ++i)
    if (!(std::abs(l.delta_at(i)) < max_delta_m) || !(std::abs(l.lambda_at(i)) < limits::force_N)) return false;
  why = "rate or retardation time not finite or out of range";
  for (int i = 0; i < l.rows; ++i)
    if (!(std::abs(l.rate_at(i)) < max_rate) || !(l.retardation_time_at(i) >= 0 && l.retardation_time_at(i) <= max_retardation_time_s)) return false;
  return true;
}

/// A solver stops at a tolerance and friction is rounded to float32 on the way.
double slack(double bound) { return 1e-6 + 1e-4 * std::abs(bound); }

bool lambda_in_law(const ProblemLayout& l, int block, int row) {
  const double first = l.lambda_at(row);
  if (l.law_at(block) == 0) {
    const double lower = l.lower_at(block), upper = l.upper_at(block);
    return (lower == -infinite || first >= lower - slack(lower)) && (upper == infinite || first <= upper + slack(upper));
  }
  if (l.law_at(block) == 2) {
    double pressed = 0;
    for (int i = row - l.normals_at(block); i < row; ++i) pressed += std::max(0.0, l.lambda_at(i));
    const double disc = l.friction_at(block) * pressed;
    return std::hypot(first, l.lambda_at(row + 1)) <= disc + slack(disc);
  }
  const double cone = l.friction_at(block) * std::max(first, 0.0);
  return first >= -slack(0) && std::hypot(l.lambda_at(row + 1), l.lambda_at(row + 2)) <= cone + slack(cone);
}

/// A patch shares the forces of one-row blocks just before it.
bool patch_ok(const ProblemLayout& l, int block) {
  const int n = l.normals_at(block);
  if (l.law_at(block) != 2) return n == 0;
  if (n < 1 || n > block) return false;
  for (int b = block - n; b < block; ++b)
    if (l.law_at(b) != 0) return false;
  return true;
}

bool blocks_ok(const ProblemLayout& l, const char*& why) {
  int row = 0;
  for (int b = 0; b < l.blocks; ++b) {
    const int law = l.law_at(b);
    why = "unknown law";
    if (law < 0 || law > 2) return false;
    why = "unknown owner or role";
    if (l.owner_at(b) < -1 || l.role_at(b) < 0 || l.role_at(b) > int(BlockRole::last)) return false;
    why = "a patch without the contacts it is of";
    if (!patch_ok(l, b)) return false;
    why = "blocks do not cover the rows once, in order";
    const int end = row + Block{.law = LawKind(law)}.rows();
    if (l.row_at(b) != row || end > l.rows) return false;
    why = "block compliance out of range";
    if (!(l.compliance_at(b) >= 0 && l.compliance_at(b) <= max_block_compliance)) return false;
    why = "block bounds are no interval";
    if (!(l.lower_at(b) <= l.upper_at(b)) || l.lower_at(b) == infinite || l.upper_at(b) == -infinite) return false;
    why = "friction out of range";
    if (!(l.friction_at(b) >= 0 && l.friction_at(b) <= 10)) return false;
    why = "directions turn too far in a step";
    for (int axis = 0; axis < 3; ++axis)
      if (!(std::abs(l.frame_rotation_at(b, axis)) <= max_frame_rotation_rad)) return false;
    why = "lambda outside its law";
    if (!lambda_in_law(l, b, row)) return false;
    row = end;
  }
  why = "blocks do not cover the rows once, in order";
  if (row != l.rows) return false;
  why = "the same block id twice";
  std::array<std::uint64_t, max_problem_rows> ids;
  for (int b = 0; b < l.blocks; ++b) ids[std::size_t(b)] = l.id_at(b);
  const auto end = ids.begin() + l.blocks;
  std::sort(ids.begin(), end);
  return std::adjacent_find(ids.begin(), end) == end;
}

bool pose_ok(const std::uint8_t* at) {
  double v[7];
  load_doubles(at, 7, v);
  return within(v, 3, limits::position_m) && unit_quaternion(v + 3);
}

/// Symmetric within rounding (of a factorisation too), non-negative diagonal.
bool symmetric_ok(const double* m, double most) {
  if (!within(m, 36, most)) return false;
  for (int i = 0; i < 6; ++i) {
    if (m[7 * i] < 0) return false;
    for (int j = 0; j < i; ++j) {
      const double a = m[6 * i + j], b = m[6 * j + i];
      if (std::abs(a - b) > 1e-5 * (std::sqrt(m[7 * i] * m[7 * j]) + std::max(std::abs(a), std::abs(b))) + 1e-12)
        return false;
    }
  }
  return true;
}

bool tools_ok(const ProblemLayout& l, const char*& why) {
  for (int t = 0; t < l.tools; ++t) {
    const std::uint8_t* at = l.tool_at(t);
    why = "tool's hand is neither left nor right, or both tools are in one hand";
    if (*at > 1 || (t == 1 && *at == *l.tool_at(0))) return false;
    why = "tool pose out of range or no unit quaternion";
    if (!pose_ok(at + 1) || !pose_ok(at + free_at) || !pose_ok(at + offset_at)) return false;
    double m[36];
    why = "tool's swept displacement too long";
    load_doubles(at + swept_displacement_at, 3, m);
    if (!within(m, 3, limits::position_m)) return false;
    at += matrices_at;
    load_doubles(at, 36, m);
    why = "tool gain out of range";
    if (!within(m, 36, max_gain)) return false;
    load_doubles(at + matrix_bytes, 36, m);
    why = "tool compliance out of range or not symmetric";
    if (!symmetric_ok(m, max_compliance)) return false;
    load_doubles(at + 2 * matrix_bytes, 36, m);
    why = "coupling stiffness out of range or not symmetric";
    if (!symmetric_ok(m, max_stiffness)) return false;
  }
  why = "Jacobian not finite or too large";
  const auto count = std::size_t(l.tools) * std::size_t(l.rows) * 6;
  for (std::size_t k = 0; k < count; ++k)
    if (!(std::abs(l.jacobian_at(k)) < max_jacobian)) return false;
  return true;
}

}  // namespace

bool plausible_problem(const ProblemLayout& l, const char*& why) {
  return header_ok(l, why) && matrix_ok(l, why) && blocks_ok(l, why) && tools_ok(l, why);
}

}  // namespace insula::wire
