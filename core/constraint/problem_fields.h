// SPDX-License-Identifier: GPL-3.0-or-later
// The fields of a constraint problem that have a value for each row or each block, listed once. The list drives
// resizing, the copies of chosen rows, encoding, decoding and the check of ranges. A new field is a member of
// ConstraintProblem or Block, a line here, and a line at the same position of lcm_types/haptic_problem.lcm.
#pragma once
#include <array>
#include <cmath>
#include <tuple>
#include <type_traits>

#include "core/constraint/problem.h"

namespace insula {

/// Values that a message may hold: finite or within closed bounds. `reason` is reported when a value is refused.
struct FieldRange {
  double least, most;
  const char* reason;
  bool holds(double x) const { return x >= least && x <= most; }  // false for NaN
};
/// |x| < bound.
constexpr FieldRange below(double bound, const char* reason) {
  return {-bound * (1 - 1e-9), bound * (1 - 1e-9), reason};
}
inline constexpr FieldRange any_value{-infinite, infinite, ""};

/// A number for each row. Wire: its type in a message.
template <class WireType>
struct RowField {
  using Wire = WireType;
  std::vector<double> ConstraintProblem::*values;
  FieldRange range;
};

/// A number (or `count` numbers) for each block.
template <class WireType, class MemberType>
struct BlockField {
  using Wire = WireType;
  using Member = MemberType;
  static constexpr bool is_array = !std::is_arithmetic_v<Member> && !std::is_enum_v<Member>;
  static constexpr std::size_t count = [] {
    if constexpr (is_array) return std::tuple_size_v<Member>;
    else return std::size_t(1);
  }();
  Member Block::*member;
  FieldRange range;

  Wire get(const Block& b, std::size_t k) const {
    if constexpr (is_array) return Wire((b.*member)[k]);
    else return Wire(b.*member);
  }
  void set(Block& b, std::size_t k, Wire value) const {
    if constexpr (is_array) (b.*member)[k] = value;
    else b.*member = Member(value);
  }
};
template <class Wire, class Member>
constexpr BlockField<Wire, Member> block_field(Member Block::*member, FieldRange range = any_value) {
  return {member, range};
}

/// In the order of the message.
inline constexpr auto row_fields = std::tuple{
    RowField<double>{&ConstraintProblem::delta_free, below(1, "delta_free or lambda not finite or too large")},
    RowField<double>{&ConstraintProblem::lambda, below(1e4, "delta_free or lambda not finite or too large")},
    RowField<float>{&ConstraintProblem::rate, below(1e3, "rate or retardation time not finite or out of range")},
    RowField<float>{&ConstraintProblem::retardation_time,
                    {0, 100, "rate or retardation time not finite or out of range"}},
};
inline constexpr auto block_fields = std::tuple{
    block_field<std::int64_t>(&Block::id),
    block_field<std::int16_t>(&Block::row),
    block_field<std::int8_t>(&Block::law, {0, 2, "unknown law"}),
    block_field<float>(&Block::compliance, {0, 1e6, "block compliance out of range"}),
    block_field<double>(&Block::lower, {-infinite, infinite, "block bounds are no interval"}),
    block_field<double>(&Block::upper, {-infinite, infinite, "block bounds are no interval"}),
    block_field<float>(&Block::friction, {0, 10, "friction out of range"}),
    block_field<std::int16_t>(&Block::normals),
    block_field<std::int32_t>(&Block::owner, {-1, infinite, "unknown owner or role"}),
    block_field<std::int8_t>(&Block::role, {0, double(BlockRole::last), "unknown owner or role"}),
    block_field<float>(&Block::frame_rotation, {-1, 1, "directions turn too far in a step"}),
    block_field<std::int16_t>(&Block::failure_group, {0, infinite, "limit of failure out of range"}),
    block_field<float>(&Block::failure_travel, {0, 1, "limit of failure out of range"}),
    block_field<float>(&Block::failure_force, {0, 1e4, "limit of failure out of range"}),
};

/// Calls f(field, index) for each field of a list.
template <class Fields, class F>
constexpr void for_each_field(const Fields& fields, F&& f) {
  std::apply(
      [&](const auto&... field) {
        std::size_t index = 0;
        (f(field, index++), ...);
      },
      fields);
}

/// Copies row `s` of `from` to row `d` of `to`, except for W and the tools' Jacobians. With a reduced model, `to` must
/// have the modes of `from`.
inline void copy_row(const ConstraintProblem& from, std::size_t s, ConstraintProblem& to, std::size_t d) {
  for_each_field(row_fields, [&](const auto& f, std::size_t) { (to.*f.values)[d] = (from.*f.values)[s]; });
  if (!to.reduced.empty()) std::copy_n(from.reduced.row(s), from.reduced.modes.size(), to.reduced.row(d));
}

/// Copies the values that a problem has once.
inline void copy_scalars(const ConstraintProblem& from, ConstraintProblem& to) {
  to.step_s = from.step_s;
  to.prediction_horizon_steps = from.prediction_horizon_steps;
}

}  // namespace insula
