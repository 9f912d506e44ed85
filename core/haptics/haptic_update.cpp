// SPDX-License-Identifier: GPL-3.0-or-later
// Flat encoder and decoder of haptic_problem_t. The decoder first validates the bytes in place, and writes only after
// that.
#include "core/haptics/haptic_update.h"

#include <algorithm>
#include <insula_lcm/haptic_problem_t.hpp>

#include "core/bus/byte_io.h"
#include "core/bus/channels.h"
#include "core/haptics/haptic_layout.h"

namespace insula {
namespace {

using wire::ProblemLayout;

bool has_wire_form(const ConstraintProblem& p) {
  const auto rows = std::size_t(p.rows);
  if (p.rows < 0 || p.rows > max_problem_rows || p.tools.size() > max_problem_tools || p.blocks.size() > rows)
    return false;
  bool whole = true;
  for_each_field(row_fields, [&](const auto& f, std::size_t) { whole = whole && (p.*f.values).size() >= rows; });
  if (!whole) return false;
  if (p.rows > 0 && (p.stride < p.rows || p.w.size() < rows * std::size_t(p.stride))) return false;
  if (!wire::patches_fit(p.patches) || !wire::reduced_model_fits(p.reduced, p.rows)) return false;
  return std::all_of(p.tools.begin(), p.tools.end(), [&](const ToolTerms& t) { return t.jacobian.rows() == p.rows; });
}

void write_pose(ByteWriter& w, const Pose& pose) {
  for (int i = 0; i < 3; ++i) w.f64(pose.p[i]);
  w.f64(pose.q.w());
  w.f64(pose.q.x());
  w.f64(pose.q.y());
  w.f64(pose.q.z());
}

void write_matrix(ByteWriter& w, const Mat6& m) {
  for (int i = 0; i < 6; ++i)
    for (int j = 0; j < 6; ++j) w.f64(m(i, j));
}

void write_rows(ByteWriter& w, const ConstraintProblem& p) {
  w.i32(p.rows);
  w.i32(p.rows * (p.rows + 1) / 2);
  for (int i = 0; i < p.rows; ++i)
    for (int j = 0; j <= i; ++j) w.f32(float(p.w_at(i, j)));
  for_each_field(row_fields, [&]<class Field>(const Field& f, std::size_t) {
    for (int i = 0; i < p.rows; ++i) w.number(typename Field::Wire((p.*f.values)[std::size_t(i)]));
  });
}

void write_tool(ByteWriter& w, const ToolTerms& tool, const Pose& offset) {
  w.i8(std::int8_t(tool.hand));
  write_pose(w, tool.device);
  for (int i = 0; i < 3; ++i) w.f64(tool.swept_displacement[i]);
  write_pose(w, tool.free);
  write_matrix(w, tool.gain);
  write_matrix(w, tool.compliance);
  write_matrix(w, tool.stiffness);
  write_pose(w, offset);
}

Pose read_pose(const std::uint8_t* at) {
  double v[7];
  wire::load_doubles(at, 7, v);
  return {Vec3(v[0], v[1], v[2]), Quat(v[3], v[4], v[5], v[6])};
}

Mat6 read_matrix(const std::uint8_t* at) {
  Eigen::Matrix<double, 6, 6, Eigen::RowMajor> m;
  wire::load_doubles(at, 36, m.data());
  return m;
}

void read_tool(const ProblemLayout& l, int t, ToolTerms& tool, Pose& offset) {
  const std::uint8_t* at = l.tool_at(t);
  tool.hand = *at;
  tool.device = read_pose(at + 1);
  wire::load_doubles(at + wire::swept_displacement_at, 3, tool.swept_displacement.data());
  tool.free = read_pose(at + wire::free_at);
  tool.gain = read_matrix(at + wire::matrices_at);
  tool.compliance = read_matrix(at + wire::matrices_at + wire::matrix_bytes);
  tool.stiffness = read_matrix(at + wire::matrices_at + 2 * wire::matrix_bytes);
  offset = read_pose(at + wire::offset_at);
  tool.jacobian.resize(l.rows, 6);
  const auto count = std::size_t(l.rows) * 6, first = std::size_t(t) * count;
  for (std::size_t k = 0; k < count; ++k) tool.jacobian.data()[k] = l.jacobian_at(first + k);
}

void read_all(const ProblemLayout& l, HapticUpdate& into) {
  into.session = l.session;
  into.sequence = l.sequence;
  into.time_us = l.time_us;
  into.pose_time_us = l.pose_time_us;
  into.step_s = l.step_s;
  into.sim_time_s = l.sim_time_s;
  ConstraintProblem& p = into.problem;
  p.resize(l.rows);
  p.step_s = l.step_s;
  p.prediction_horizon_steps = l.prediction_horizon_steps;
  std::size_t k = 0;
  const auto stride = std::size_t(p.stride);
  for (std::size_t i = 0; i < std::size_t(l.rows); ++i)
    for (std::size_t j = 0; j <= i; ++j, ++k) p.w[i * stride + j] = p.w[j * stride + i] = l.w_at(k);
  for_each_field(row_fields, [&](const auto& f, std::size_t index) {
    for (int i = 0; i < l.rows; ++i) (p.*f.values)[std::size_t(i)] = l.row_value(f, index, i);
  });
  p.blocks.resize(std::size_t(l.blocks));
  for (int b = 0; b < l.blocks; ++b) p.blocks[std::size_t(b)] = l.block_at(b);
  p.tools.resize(std::size_t(l.tools));
  for (int t = 0; t < l.tools; ++t) read_tool(l, t, p.tools[std::size_t(t)], into.offset[std::size_t(t)]);
  wire::read_patches(l, p.patches);
  wire::read_reduced_model(l, p.reduced);
}

}  // namespace

bool encode_problem(const ProblemStamp& stamp, const ConstraintProblem& p, const std::array<bool, 2>& left_out,
                    std::vector<std::uint8_t>& out) {
  ByteWriter w(out);
  if (!has_wire_form(p)) return false;
  const auto stays = [&](const ToolTerms& t) { return t.hand < 0 || t.hand > 1 || !left_out[std::size_t(t.hand)]; };
  const auto tools = int(std::count_if(p.tools.begin(), p.tools.end(), stays));
  w.i64(insula_lcm::haptic_problem_t::getHash());
  w.i64(stamp.session);
  w.i64(stamp.sequence);
  w.i64(stamp.time_us);
  w.i64(stamp.pose_time_us);
  w.f64(stamp.step_s);
  w.f64(stamp.sim_time_s);
  write_rows(w, p);
  w.f64(p.prediction_horizon_steps);
  w.i32(int(p.blocks.size()));
  for_each_field(block_fields, [&](const auto& f, std::size_t) {
    for (const Block& b : p.blocks)
      for (std::size_t k = 0; k < f.count; ++k) w.number(f.get(b, k));
  });
  w.i8(std::int8_t(tools));
  for (std::size_t t = 0; t < p.tools.size(); ++t)
    if (stays(p.tools[t])) write_tool(w, p.tools[t], stamp.offset[t]);
  w.i32(tools * p.rows * 6);
  for (const ToolTerms& tool : p.tools)
    for (int i = 0; i < p.rows && stays(tool); ++i)
      for (int c = 0; c < 6; ++c) w.f32(float(tool.jacobian(i, c)));
  std::array<int, 2> tool_number{-1, -1};
  for (std::size_t t = 0, number = 0; t < p.tools.size(); ++t)
    if (stays(p.tools[t])) tool_number[t] = int(number++);
  wire::write_patches(w, p.patches, tool_number);
  wire::write_reduced_model(w, p.reduced, p.rows);
  w.i32(0);
  seal_problem(out);
  return true;
}

void seal_problem(std::vector<std::uint8_t>& message) {
  if (message.size() < 4) return;
  const std::size_t end = message.size() - 4;
  const std::uint32_t sum = __builtin_bswap32(wire::problem_checksum(Bytes(message.data(), end)));
  std::memcpy(message.data() + end, &sum, 4);
}

bool decode_problem(Bytes bytes, HapticUpdate& into, std::string& why) {
  const char* reason = "message too large";
  ProblemLayout l;
  if (bytes.size() > max_message_bytes || !wire::find_parts(bytes, l, reason) || !wire::plausible_problem(l, reason)) {
    why = reason;
    return false;
  }
  read_all(l, into);
  return true;
}

}  // namespace insula
