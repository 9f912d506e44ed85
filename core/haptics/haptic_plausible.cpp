// SPDX-License-Identifier: GPL-3.0-or-later
// Checks of a haptic_problem_t: magnitudes, laws, blocks, tools.
#include <algorithm>
#include <array>
#include <cmath>

#include "core/bus/plausible.h"
#include "core/haptics/haptic_layout.h"
#include "core/haptics/haptic_update.h"

namespace insula::wire {
namespace {

constexpr double max_w = 1e4, max_jacobian = 1e3, max_prediction_horizon_steps = 100;
constexpr double max_gain = 1e4, max_compliance = 1e8, max_stiffness = 1e8;

bool header_ok(const ProblemLayout& l, const char*& why) {
  why = "time, step or sequence out of range";
  return l.session >= 0 && l.sequence >= 0 && l.time_us >= 0 && l.pose_time_us >= 0 && l.step_s > 0 && l.step_s <= 1 &&
         l.sim_time_s >= 0 && l.sim_time_s <= 1e9 && l.prediction_horizon_steps >= 0 &&
         l.prediction_horizon_steps <= max_prediction_horizon_steps;
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
  const char* bad = nullptr;
  for_each_field(row_fields, [&](const auto& f, std::size_t index) {
    for (int i = 0; !bad && i < l.rows; ++i)
      if (!f.range.holds(l.row_value(f, index, i))) bad = f.range.reason;
  });
  if (bad) why = bad;
  return bad == nullptr;
}

/// A solver stops at a tolerance, and friction is rounded to float32 in the message.
double slack(double bound) { return 1e-6 + 1e-4 * std::abs(bound); }

bool lambda_in_law(const ProblemLayout& l, const Block& b) {
  const double first = l.lambda_at(b.row);
  if (b.law == LawKind::box)
    return (b.lower == -infinite || first >= b.lower - slack(b.lower)) &&
           (b.upper == infinite || first <= b.upper + slack(b.upper));
  if (b.law == LawKind::patch) {
    double pressed = 0;
    for (int i = b.row - b.normals; i < b.row; ++i) pressed += std::max(0.0, l.lambda_at(i));
    const double disc = b.friction * pressed;
    return std::hypot(first, l.lambda_at(b.row + 1)) <= disc + slack(disc);
  }
  const double cone = b.friction * std::max(first, 0.0);
  return first >= -slack(0) && std::hypot(l.lambda_at(b.row + 1), l.lambda_at(b.row + 2)) <= cone + slack(cone);
}

/// A patch shares the forces of one-row blocks just before it.
bool patch_ok(const ProblemLayout& l, const Block& b, int index) {
  if (b.law != LawKind::patch) return b.normals == 0;
  if (b.normals < 1 || b.normals > index) return false;
  for (int k = index - b.normals; k < index; ++k)
    if (const Block of = l.block_at(k); of.law != LawKind::box || of.role == BlockRole::surface) return false;
  return true;
}

/// Every number of a block is in its range.
bool block_ok(const ProblemLayout& l, int block, const char*& why) {
  const char* bad = nullptr;
  for_each_field(block_fields, [&](const auto& f, std::size_t index) {
    for (std::size_t k = 0; k < f.count; ++k)
      if (!bad && !f.range.holds(double(l.block_value(f, index, block, k)))) bad = f.range.reason;
  });
  if (bad) why = bad;
  return bad == nullptr;
}

bool blocks_ok(const ProblemLayout& l, const char*& why) {
  std::array<std::uint64_t, max_problem_rows> ids;
  int row = 0;
  for (int k = 0; k < l.blocks; ++k) {
    if (!block_ok(l, k, why)) return false;
    const Block b = l.block_at(k);
    ids[std::size_t(k)] = b.id;
    why = "a patch without the contacts it is of";
    if (!patch_ok(l, b, k)) return false;
    why = "blocks do not cover the rows once, in order";
    const int end = row + b.rows();
    if (b.row != row || end > l.rows) return false;
    why = "block bounds are no interval";
    if (b.lower > b.upper || b.lower == infinite || b.upper == -infinite) return false;
    why = "lambda outside its law";
    if (!lambda_in_law(l, b)) return false;
    row = end;
  }
  why = "blocks do not cover the rows once, in order";
  if (row != l.rows) return false;
  why = "the same block id twice";
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
  return header_ok(l, why) && matrix_ok(l, why) && blocks_ok(l, why) && tools_ok(l, why) && plausible_patches(l, why) &&
         plausible_reduced_model(l, why);
}

}  // namespace insula::wire
