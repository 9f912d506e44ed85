// SPDX-License-Identifier: GPL-3.0-or-later
// The layout of a haptic_problem_t message.
#include "core/haptics/haptic_layout.h"

#include <zlib.h>

#include <insula_lcm/haptic_problem_t.hpp>

#include "core/haptics/haptic_update.h"

namespace insula::wire {
namespace {

template <class Field>
constexpr std::size_t wire_bytes(const Field&) {
  return sizeof(typename Field::Wire);
}

}  // namespace

std::uint32_t problem_checksum(Bytes bytes) { return std::uint32_t(::crc32(0, bytes.data(), unsigned(bytes.size()))); }

bool find_parts(Bytes bytes, ProblemLayout& l, const char*& why) {
  why = "not a haptic_problem_t message";
  ByteReader in(bytes);
  if (in.i64() != insula_lcm::haptic_problem_t::getHash() || !in.ok()) return false;
  l.session = in.i64();
  l.sequence = in.i64();
  l.time_us = in.i64();
  l.pose_time_us = in.i64();
  l.step_s = in.f64();
  l.sim_time_s = in.f64();
  l.rows = in.i32();
  const std::int32_t packed = in.i32();
  if (!in.ok()) return false;
  if (l.rows < 0 || l.rows > max_problem_rows || packed != l.rows * (l.rows + 1) / 2) {
    why = "row count out of range or packed size wrong";
    return false;
  }
  l.w = in.take_array(packed, 4);
  for_each_field(row_fields,
                 [&](const auto& f, std::size_t index) { l.row_values[index] = in.take_array(l.rows, wire_bytes(f)); });
  l.prediction_horizon_steps = in.f64();
  l.blocks = in.i32();
  if (!in.ok()) return false;
  if (l.blocks < 0 || l.blocks > l.rows) {
    why = "block count out of range";
    return false;
  }
  for_each_field(block_fields, [&](const auto& f, std::size_t index) {
    l.block_values[index] = in.take_array(l.blocks * int(f.count), wire_bytes(f));
  });
  l.tools = in.i8();
  if (!in.ok()) return false;
  if (l.tools < 0 || l.tools > max_problem_tools) {
    why = "more than two tools";
    return false;
  }
  l.tool = in.take_array(l.tools, tool_bytes);
  const std::int32_t jacobian_size = in.i32();
  if (!in.ok()) return false;
  if (jacobian_size != l.tools * l.rows * 6) {
    why = "Jacobian size does not match tools and rows";
    return false;
  }
  l.jacobian = in.take_array(jacobian_size, 4);
  if (!in.ok()) return false;
  l.patches = bytes.last(in.left());
  if (!skip_patches(in)) {
    why = "sizes of surface patches out of range";
    return false;
  }
  l.reduced = bytes.last(in.left());
  if (!skip_reduced_model(in, l.rows)) {
    why = "sizes of the reduced model out of range";
    return false;
  }
  const auto said = std::uint32_t(in.i32());
  if (!in.at_end()) return false;
  why = "damaged on its way: the checksum is wrong";
  return said == problem_checksum(bytes.first(bytes.size() - 4));
}

}  // namespace insula::wire
