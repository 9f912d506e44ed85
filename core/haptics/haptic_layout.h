// SPDX-License-Identifier: GPL-3.0-or-later
// Positions of the parts of a haptic_problem_t message, and checks of their content. Nothing is copied or written.
#pragma once
#include <array>
#include <cstddef>
#include <cstdint>

#include "core/bus/bus.h"
#include "core/bus/byte_io.h"
#include "core/constraint/problem_fields.h"
#include "core/haptics/patch_wire.h"
#include "core/haptics/reduced_wire.h"

namespace insula::wire {

inline constexpr std::size_t pose_bytes = 7 * 8, matrix_bytes = 36 * 8;
// A tool: hand, device pose and displacement, free pose, three matrices, offset.
inline constexpr std::size_t swept_displacement_at = 1 + pose_bytes, free_at = swept_displacement_at + 3 * 8,
                             matrices_at = free_at + pose_bytes;
inline constexpr std::size_t offset_at = matrices_at + 3 * matrix_bytes, tool_bytes = offset_at + pose_bytes;

inline void load_doubles(const std::uint8_t* from, int count, double* to) {
  for (int i = 0; i < count; ++i) to[i] = load_double(from + 8 * i);
}

/// Null for empty arrays is never read.
struct ProblemLayout {
  std::int64_t session, sequence, time_us, pose_time_us;
  double step_s, sim_time_s, prediction_horizon_steps;
  int rows, blocks, tools;
  const std::uint8_t *w, *tool, *jacobian;
  Bytes patches;  ///< from the first list on
  Bytes reduced;  ///< from the number of bodies on
  std::array<const std::uint8_t*, std::tuple_size_v<decltype(row_fields)>> row_values;  ///< in the order of row_fields
  std::array<const std::uint8_t*, std::tuple_size_v<decltype(block_fields)>>
      block_values;  ///< in the order of block_fields

  double w_at(std::size_t k) const { return double(load_float(w + 4 * k)); }
  template <class Field>
  double row_value(const Field&, std::size_t index, int row) const {
    return double(load<typename Field::Wire>(row_values[index] + sizeof(typename Field::Wire) * std::size_t(row)));
  }
  template <class Field>
  typename Field::Wire block_value(const Field&, std::size_t index, int block, std::size_t k) const {
    return load<typename Field::Wire>(block_values[index] +
                                      sizeof(typename Field::Wire) * (std::size_t(block) * Field::count + k));
  }
  double lambda_at(int row) const { return load_double(row_values[1] + 8 * row); }
  Block block_at(int block) const {
    Block out;
    for_each_field(block_fields, [&](const auto& f, std::size_t index) {
      for (std::size_t k = 0; k < f.count; ++k) f.set(out, k, block_value(f, index, block, k));
    });
    return out;
  }
  const std::uint8_t* tool_at(int t) const { return tool + tool_bytes * std::size_t(t); }
  double jacobian_at(std::size_t k) const { return double(load_float(jacobian + 4 * k)); }
};

static_assert(std::get<1>(row_fields).values == &ConstraintProblem::lambda);

/// Layout of a message without its last four bytes.
std::uint32_t problem_checksum(Bytes bytes);

/// Structure: the kind of message, sizes that agree with each other and with its length, and the checksum. False with
/// the reason in `why`.
bool find_parts(Bytes bytes, ProblemLayout& layout, const char*& why);

/// Content: every number is finite and of plausible magnitude, with the other guarantees of decode_problem().
bool plausible_problem(const ProblemLayout& layout, const char*& why);

}  // namespace insula::wire
