// SPDX-License-Identifier: GPL-3.0-or-later
// Flat encoder and decoder of haptic_problem_t. The decoder validates the bytes in place first and writes only then.
#include "core/bus/haptic_update.h"

#include <zlib.h>

#include <algorithm>
#include <cmath>
#include <insula_lcm/haptic_problem_t.hpp>

#include "core/bus/byte_io.h"
#include "core/bus/channels.h"
#include "core/bus/plausible.h"

namespace insula {
namespace {

constexpr double most_delta_m = 1, most_w = 1e4, most_jacobian = 1e3;
constexpr double most_rate = 1e3, most_relaxation_s = 100;
constexpr double most_gain = 1e4, most_compliance = 1e8, most_stiffness = 1e8, most_block_compliance = 1e6;

// --- writing --------------------------------------------------------------------------------------------------------------

bool has_wire_form(const ConstraintProblem& p) {
  const auto rows = std::size_t(p.rows);
  if (p.rows < 0 || p.rows > max_problem_rows || p.tools.size() > max_problem_tools || p.blocks.size() > rows) return false;
  if (p.delta_free.size() < rows || p.lambda.size() < rows || p.rate.size() < rows || p.relaxation.size() < rows) return false;
  if (p.rows > 0 && (p.stride < p.rows || p.w.size() < rows * std::size_t(p.stride))) return false;
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

std::uint32_t checksum(Bytes bytes) { return std::uint32_t(::crc32(0, bytes.data(), unsigned(bytes.size()))); }

// --- reading --------------------------------------------------------------------------------------------------------------

constexpr std::size_t pose_bytes = 7 * 8, matrix_bytes = 36 * 8;
constexpr std::size_t tool_bytes = 1 + 2 * pose_bytes + 3 * matrix_bytes + pose_bytes;

/// Where each part of a message lies; null for empty arrays is never read.
struct Layout {
  std::int64_t session, sequence, time_us, pose_time_us;
  double step_s, sim_time_s;
  int rows, blocks, tools;
  const std::uint8_t *w, *delta, *lambda, *rate, *relaxation, *id, *row, *law, *compliance, *lower, *upper, *friction, *normals, *tool, *jacobian;

  double w_at(std::size_t k) const { return double(wire::load_float(w + 4 * k)); }
  double delta_at(int i) const { return wire::load_double(delta + 8 * i); }
  double lambda_at(int i) const { return wire::load_double(lambda + 8 * i); }
  double rate_at(int i) const { return double(wire::load_float(rate + 4 * i)); }
  double relaxation_at(int i) const { return double(wire::load_float(relaxation + 4 * i)); }
  std::uint64_t id_at(int b) const { return wire::load64(id + 8 * b); }
  int row_at(int b) const { return std::int16_t(wire::load16(row + 2 * b)); }
  int law_at(int b) const { return std::int8_t(law[b]); }
  double compliance_at(int b) const { return double(wire::load_float(compliance + 4 * b)); }
  double lower_at(int b) const { return wire::load_double(lower + 8 * b); }
  double upper_at(int b) const { return wire::load_double(upper + 8 * b); }
  double friction_at(int b) const { return double(wire::load_float(friction + 4 * b)); }
  int normals_at(int b) const { return std::int16_t(wire::load16(normals + 2 * b)); }
  const std::uint8_t* tool_at(int t) const { return tool + tool_bytes * std::size_t(t); }
  double jacobian_at(std::size_t k) const { return double(wire::load_float(jacobian + 4 * k)); }
};

bool find_parts(Bytes bytes, Layout& l, const char*& why) {
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
  l.delta = in.take_array(l.rows, 8);
  l.lambda = in.take_array(l.rows, 8);
  l.rate = in.take_array(l.rows, 4);
  l.relaxation = in.take_array(l.rows, 4);
  l.blocks = in.i32();
  if (!in.ok()) return false;
  if (l.blocks < 0 || l.blocks > l.rows) {
    why = "block count out of range";
    return false;
  }
  l.id = in.take_array(l.blocks, 8);
  l.row = in.take_array(l.blocks, 2);
  l.law = in.take_array(l.blocks, 1);
  l.compliance = in.take_array(l.blocks, 4);
  l.lower = in.take_array(l.blocks, 8);
  l.upper = in.take_array(l.blocks, 8);
  l.friction = in.take_array(l.blocks, 4);
  l.normals = in.take_array(l.blocks, 2);
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
  const auto said = std::uint32_t(in.i32());
  if (!in.at_end()) return false;
  why = "damaged on its way: the checksum is wrong";
  return said == checksum(bytes.first(bytes.size() - 4));
}

bool header_ok(const Layout& l, const char*& why) {
  why = "time, step or sequence out of range";
  return l.session >= 0 && l.sequence >= 0 && l.time_us >= 0 && l.pose_time_us >= 0 && l.step_s > 0 && l.step_s <= 1 && l.sim_time_s >= 0 &&
         l.sim_time_s <= 1e9;
}

bool matrix_ok(const Layout& l, const char*& why) {
  why = "W not finite or too large";
  std::size_t k = 0;
  for (int i = 0; i < l.rows; ++i)
    for (int j = 0; j <= i; ++j, ++k)
      if (!(std::abs(l.w_at(k)) < most_w)) return false;
  why = "W has a negative diagonal";
  for (int i = 0; i < l.rows; ++i)
    if (l.w_at(std::size_t(i) * std::size_t(i + 3) / 2) < 0) return false;
  why = "delta_free or lambda not finite or too large";
  for (int i = 0; i < l.rows; ++i)
    if (!(std::abs(l.delta_at(i)) < most_delta_m) || !(std::abs(l.lambda_at(i)) < limits::force_N)) return false;
  why = "rate or relaxation not finite or out of range";
  for (int i = 0; i < l.rows; ++i)
    if (!(std::abs(l.rate_at(i)) < most_rate) || !(l.relaxation_at(i) >= 0 && l.relaxation_at(i) <= most_relaxation_s)) return false;
  return true;
}

/// A solver stops at a tolerance and friction is rounded to float32 on the way.
double slack(double bound) { return 1e-6 + 1e-4 * std::abs(bound); }

bool lambda_in_law(const Layout& l, int block, int row) {
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
bool patch_ok(const Layout& l, int block) {
  const int n = l.normals_at(block);
  if (l.law_at(block) != 2) return n == 0;
  if (n < 1 || n > block) return false;
  for (int b = block - n; b < block; ++b)
    if (l.law_at(b) != 0) return false;
  return true;
}

bool blocks_ok(const Layout& l, const char*& why) {
  int row = 0;
  for (int b = 0; b < l.blocks; ++b) {
    const int law = l.law_at(b);
    why = "unknown law";
    if (law < 0 || law > 2) return false;
    why = "a patch without the contacts it is of";
    if (!patch_ok(l, b)) return false;
    why = "blocks do not cover the rows once, in order";
    const int end = row + Block{.law = LawKind(law)}.rows();
    if (l.row_at(b) != row || end > l.rows) return false;
    why = "block compliance out of range";
    if (!(l.compliance_at(b) >= 0 && l.compliance_at(b) <= most_block_compliance)) return false;
    why = "block bounds are no interval";
    if (!(l.lower_at(b) <= l.upper_at(b)) || l.lower_at(b) == infinite || l.upper_at(b) == -infinite) return false;
    why = "friction out of range";
    if (!(l.friction_at(b) >= 0 && l.friction_at(b) <= 10)) return false;
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

void load_doubles(const std::uint8_t* from, int count, double* to) {
  for (int i = 0; i < count; ++i) to[i] = wire::load_double(from + 8 * i);
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

bool tools_ok(const Layout& l, const char*& why) {
  for (int t = 0; t < l.tools; ++t) {
    const std::uint8_t* at = l.tool_at(t);
    why = "tool's hand is neither left nor right, or both tools are in one hand";
    if (*at > 1 || (t == 1 && *at == *l.tool_at(0))) return false;
    why = "tool pose out of range or no unit quaternion";
    if (!pose_ok(at + 1) || !pose_ok(at + 1 + pose_bytes) || !pose_ok(at + 1 + 2 * pose_bytes + 3 * matrix_bytes))
      return false;
    double m[36];
    at += 1 + 2 * pose_bytes;
    load_doubles(at, 36, m);
    why = "tool gain out of range";
    if (!within(m, 36, most_gain)) return false;
    load_doubles(at + matrix_bytes, 36, m);
    why = "tool compliance out of range or not symmetric";
    if (!symmetric_ok(m, most_compliance)) return false;
    load_doubles(at + 2 * matrix_bytes, 36, m);
    why = "coupling stiffness out of range or not symmetric";
    if (!symmetric_ok(m, most_stiffness)) return false;
  }
  why = "Jacobian not finite or too large";
  const auto count = std::size_t(l.tools) * std::size_t(l.rows) * 6;
  for (std::size_t k = 0; k < count; ++k)
    if (!(std::abs(l.jacobian_at(k)) < most_jacobian)) return false;
  return true;
}

Pose read_pose(const std::uint8_t* at) {
  double v[7];
  load_doubles(at, 7, v);
  return {Vec3(v[0], v[1], v[2]), Quat(v[3], v[4], v[5], v[6])};
}

Mat6 read_matrix(const std::uint8_t* at) {
  Eigen::Matrix<double, 6, 6, Eigen::RowMajor> m;
  load_doubles(at, 36, m.data());
  return m;
}

void read_tool(const Layout& l, int t, ToolTerms& tool, Pose& offset) {
  const std::uint8_t* at = l.tool_at(t);
  tool.hand = *at;
  tool.device = read_pose(at + 1);
  tool.free = read_pose(at + 1 + pose_bytes);
  at += 1 + 2 * pose_bytes;
  tool.gain = read_matrix(at);
  tool.compliance = read_matrix(at + matrix_bytes);
  tool.stiffness = read_matrix(at + 2 * matrix_bytes);
  offset = read_pose(at + 3 * matrix_bytes);
  tool.jacobian.resize(l.rows, 6);
  const auto count = std::size_t(l.rows) * 6, first = std::size_t(t) * count;
  for (std::size_t k = 0; k < count; ++k) tool.jacobian.data()[k] = l.jacobian_at(first + k);
}

void read_all(const Layout& l, HapticUpdate& into) {
  into.session = l.session;
  into.sequence = l.sequence;
  into.time_us = l.time_us;
  into.pose_time_us = l.pose_time_us;
  into.step_s = l.step_s;
  into.sim_time_s = l.sim_time_s;
  ConstraintProblem& p = into.problem;
  p.resize(l.rows);
  p.step_s = l.step_s;
  std::size_t k = 0;
  const auto stride = std::size_t(p.stride);
  for (std::size_t i = 0; i < std::size_t(l.rows); ++i)
    for (std::size_t j = 0; j <= i; ++j, ++k) p.w[i * stride + j] = p.w[j * stride + i] = l.w_at(k);
  for (int i = 0; i < l.rows; ++i) {
    p.delta_free[std::size_t(i)] = l.delta_at(i);
    p.lambda[std::size_t(i)] = l.lambda_at(i);
    p.rate[std::size_t(i)] = l.rate_at(i);
    p.relaxation[std::size_t(i)] = l.relaxation_at(i);
  }
  p.blocks.resize(std::size_t(l.blocks));
  for (int b = 0; b < l.blocks; ++b) {
    Block& block = p.blocks[std::size_t(b)];
    block.id = l.id_at(b);
    block.row = l.row_at(b);
    block.law = LawKind(l.law_at(b));
    block.compliance = l.compliance_at(b);
    block.lower = l.lower_at(b);
    block.upper = l.upper_at(b);
    block.friction = l.friction_at(b);
    block.normals = l.normals_at(b);
  }
  p.tools.resize(std::size_t(l.tools));
  for (int t = 0; t < l.tools; ++t) read_tool(l, t, p.tools[std::size_t(t)], into.offset[std::size_t(t)]);
}

}  // namespace

bool encode_problem(const HapticUpdate& update, std::vector<std::uint8_t>& out) {
  ByteWriter w(out);
  const ConstraintProblem& p = update.problem;
  if (!has_wire_form(p)) return false;
  w.i64(insula_lcm::haptic_problem_t::getHash());
  w.i64(update.session);
  w.i64(update.sequence);
  w.i64(update.time_us);
  w.i64(update.pose_time_us);
  w.f64(update.step_s);
  w.f64(update.sim_time_s);
  w.i32(p.rows);
  w.i32(p.rows * (p.rows + 1) / 2);
  for (int i = 0; i < p.rows; ++i)
    for (int j = 0; j <= i; ++j) w.f32(float(p.w_at(i, j)));
  for (int i = 0; i < p.rows; ++i) w.f64(p.delta_free[std::size_t(i)]);
  for (int i = 0; i < p.rows; ++i) w.f64(p.lambda[std::size_t(i)]);
  for (int i = 0; i < p.rows; ++i) w.f32(float(p.rate[std::size_t(i)]));
  for (int i = 0; i < p.rows; ++i) w.f32(float(p.relaxation[std::size_t(i)]));
  w.i32(int(p.blocks.size()));
  for (const Block& b : p.blocks) w.i64(std::int64_t(b.id));
  for (const Block& b : p.blocks) w.i16(std::int16_t(b.row));
  for (const Block& b : p.blocks) w.i8(std::int8_t(b.law));
  for (const Block& b : p.blocks) w.f32(float(b.compliance));
  for (const Block& b : p.blocks) w.f64(b.lower);
  for (const Block& b : p.blocks) w.f64(b.upper);
  for (const Block& b : p.blocks) w.f32(float(b.friction));
  for (const Block& b : p.blocks) w.i16(std::int16_t(b.normals));
  w.i8(std::int8_t(p.tools.size()));
  for (std::size_t t = 0; t < p.tools.size(); ++t) {
    const ToolTerms& tool = p.tools[t];
    w.i8(std::int8_t(tool.hand));
    write_pose(w, tool.device);
    write_pose(w, tool.free);
    write_matrix(w, tool.gain);
    write_matrix(w, tool.compliance);
    write_matrix(w, tool.stiffness);
    write_pose(w, update.offset[t]);
  }
  w.i32(int(p.tools.size()) * p.rows * 6);
  for (const ToolTerms& tool : p.tools)
    for (int i = 0; i < p.rows; ++i)
      for (int c = 0; c < 6; ++c) w.f32(float(tool.jacobian(i, c)));
  w.i32(0);
  seal_problem(out);
  return true;
}

void seal_problem(std::vector<std::uint8_t>& message) {
  if (message.size() < 4) return;
  const std::size_t end = message.size() - 4;
  const std::uint32_t sum = __builtin_bswap32(checksum(Bytes(message.data(), end)));
  std::memcpy(message.data() + end, &sum, 4);
}

bool decode_problem(Bytes bytes, HapticUpdate& into, std::string& why) {
  const char* reason = "message too large";
  Layout l;
  if (bytes.size() > max_message_bytes || !find_parts(bytes, l, reason) || !header_ok(l, reason) || !matrix_ok(l, reason) ||
      !blocks_ok(l, reason) || !tools_ok(l, reason)) {
    why = reason;
    return false;
  }
  read_all(l, into);
  return true;
}

}  // namespace insula
