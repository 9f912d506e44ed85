// SPDX-License-Identifier: GPL-3.0-or-later
// Where each part of a haptic_problem_t message lies, and whether what lies there may be believed. Nothing is copied and nothing written.
#pragma once
#include <cstddef>
#include <cstdint>

#include "core/bus/bus.h"
#include "core/bus/byte_io.h"

namespace insula::wire {

inline constexpr std::size_t pose_bytes = 7 * 8, matrix_bytes = 36 * 8;
// A tool: hand, device pose and way, free pose, three matrices, offset.
inline constexpr std::size_t swept_displacement_at = 1 + pose_bytes, free_at = swept_displacement_at + 3 * 8, matrices_at = free_at + pose_bytes;
inline constexpr std::size_t offset_at = matrices_at + 3 * matrix_bytes, tool_bytes = offset_at + pose_bytes;

inline void load_doubles(const std::uint8_t* from, int count, double* to) {
  for (int i = 0; i < count; ++i) to[i] = load_double(from + 8 * i);
}

/// Null for empty arrays is never read.
struct ProblemLayout {
  std::int64_t session, sequence, time_us, pose_time_us;
  double step_s, sim_time_s, prediction_horizon_steps;
  int rows, blocks, tools;
  const std::uint8_t *w, *delta, *lambda, *rate, *retardation_time, *id, *row, *law, *compliance, *lower, *upper, *friction, *normals, *owner, *role, *frame_rotation, *tool, *jacobian;

  double w_at(std::size_t k) const { return double(load_float(w + 4 * k)); }
  double delta_at(int i) const { return load_double(delta + 8 * i); }
  double lambda_at(int i) const { return load_double(lambda + 8 * i); }
  double rate_at(int i) const { return double(load_float(rate + 4 * i)); }
  double retardation_time_at(int i) const { return double(load_float(retardation_time + 4 * i)); }
  std::uint64_t id_at(int b) const { return load64(id + 8 * b); }
  int row_at(int b) const { return std::int16_t(load16(row + 2 * b)); }
  int law_at(int b) const { return std::int8_t(law[b]); }
  double compliance_at(int b) const { return double(load_float(compliance + 4 * b)); }
  double lower_at(int b) const { return load_double(lower + 8 * b); }
  double upper_at(int b) const { return load_double(upper + 8 * b); }
  double friction_at(int b) const { return double(load_float(friction + 4 * b)); }
  int normals_at(int b) const { return std::int16_t(load16(normals + 2 * b)); }
  std::int32_t owner_at(int b) const { return std::int32_t(load32(owner + 4 * b)); }
  int role_at(int b) const { return std::int8_t(role[b]); }
  float frame_rotation_at(int b, int axis) const { return load_float(frame_rotation + 4 * (3 * b + axis)); }
  const std::uint8_t* tool_at(int t) const { return tool + tool_bytes * std::size_t(t); }
  double jacobian_at(std::size_t k) const { return double(load_float(jacobian + 4 * k)); }
};

/// Of a message without its last four bytes.
std::uint32_t problem_checksum(Bytes bytes);

/// Structure: the kind of message, sizes that agree with each other and with its length, the checksum. False with the reason in `why`.
bool find_parts(Bytes bytes, ProblemLayout& layout, const char*& why);

/// Content: every number finite and of plausible magnitude, and what decode_problem() promises beyond that.
bool plausible_problem(const ProblemLayout& layout, const char*& why);

}  // namespace insula::wire
