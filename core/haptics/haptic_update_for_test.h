// SPDX-License-Identifier: GPL-3.0-or-later
// Haptic problems for tests of their wire format, and the properties of every accepted one.
#pragma once
#include <gtest/gtest.h>

#include <cmath>
#include <insula_lcm/haptic_problem_t.hpp>
#include <random>

#include "core/bus/mutate_for_test.h"
#include "core/constraint/problem_fields.h"
#include "core/haptics/haptic_update.h"

namespace insula::testing {

using Buffer = std::vector<std::uint8_t>;

inline Pose random_pose(std::mt19937& random) {
  std::normal_distribution<double> normal;
  Pose pose;
  pose.p = Vec3(normal(random), normal(random), normal(random)) * 0.1;
  pose.q = Quat(normal(random), normal(random), normal(random), normal(random)).normalized();
  return pose;
}

inline Mat6 random_symmetric(std::mt19937& random, double scale) {
  std::normal_distribution<double> normal;
  Mat6 a;
  for (int i = 0; i < 36; ++i) a.data()[i] = normal(random);
  return scale * (a * a.transpose());
}

/// Random numbers of a problem, one after the other.
struct ProblemRandom {
  std::mt19937 bits;
  std::normal_distribution<double> normal{};
  double operator()() { return normal(bits); }
};

/// Box blocks, and a friction block at every second place until there are `contacts` of them; with their lambda.
inline void add_blocks(ConstraintProblem& p, int boxes, int contacts, ProblemRandom& random) {
  int row = 0;
  for (int k = 0, all = boxes + contacts; k < all; ++k) {
    Block b;
    b.id = 0xfedc000000000000u + std::uint64_t(1000 + k * 7);
    b.row = row;
    b.owner = 3 * k - 1;
    b.role = BlockRole(k % (int(BlockRole::last) + 1));
    for (float& by : b.frame_rotation) by = float(0.1 * random());
    b.failure_group = k % 3;
    b.failure_travel = float(k % 4) * 1e-4F;
    b.failure_force = float(k % 5) * 0.01F;
    if (k % 2 == 1 && contacts > 0) {
      --contacts;
      b.law = LawKind::friction;
      b.friction = double(0.3f);
      p.lambda[std::size_t(row)] = 0.5;
      p.lambda[std::size_t(row + 1)] = 0.1;
      p.lambda[std::size_t(row + 2)] = -0.1;
    } else {
      b.compliance = double(0.02f);
      if (k % 4 == 0) b.upper = 0;
      p.lambda[std::size_t(row)] = -std::abs(random());
    }
    p.blocks.push_back(b);
    row += b.rows();
    if (row >= p.rows) break;
  }
}

inline ToolTerms random_tool(int hand, int rows, ProblemRandom& random) {
  ToolTerms tool;
  tool.hand = hand;
  tool.device = random_pose(random.bits);
  const double x = random(), y = random(), z = random();
  tool.swept_displacement = 0.01 * Vec3(x, y, z);
  tool.free = random_pose(random.bits);
  tool.gain = random_symmetric(random.bits, 0.01);
  tool.gain(0, 5) += 0.5;  // a gain need not be symmetric
  tool.compliance = random_symmetric(random.bits, 1e-3);
  tool.stiffness = random_symmetric(random.bits, 100);
  tool.jacobian.resize(rows, 6);
  for (int i = 0; i < rows * 6; ++i) tool.jacobian.data()[i] = double(float(random()));
  return tool;
}

/// A valid problem with friction and box blocks, with float32 values where the message has float32.
inline HapticUpdate make_update(unsigned seed, int boxes = 4, int contacts = 3, int tools = 2) {
  ProblemRandom random{std::mt19937(seed)};
  HapticUpdate u;
  u.session = 1234567890123;
  u.sequence = 77;
  u.time_us = 987654321;
  u.pose_time_us = 987650000;
  u.step_s = 1.0 / 60;
  u.sim_time_s = 3.25;
  ConstraintProblem& p = u.problem;
  const int n = boxes + 3 * contacts;
  p.resize(n);
  for (int i = 0; i < n; ++i)
    for (int j = 0; j <= i; ++j) {
      const double w = double(float(i == j ? 1e-3 + std::abs(random()) * 1e-3 : random() * 1e-5));
      p.w[std::size_t(i * p.stride + j)] = p.w[std::size_t(j * p.stride + i)] = w;
    }
  for (int i = 0; i < n; ++i) p.delta_free[std::size_t(i)] = random() * 1e-3;
  p.step_s = u.step_s;
  p.prediction_horizon_steps = 0.375;
  for (int i = 0; i < n; ++i) {
    p.rate[std::size_t(i)] = double(float(random() * 1e-2));
    p.retardation_time[std::size_t(i)] = double(float(0.01 * (i % 3)));
  }
  add_blocks(p, boxes, contacts, random);
  for (int t = 0; t < tools; ++t) {
    p.tools.push_back(random_tool(1 - t, n, random));
    u.offset[std::size_t(t)] = random_pose(random.bits);
  }
  return u;
}

inline Buffer encoded(const HapticUpdate& u) {
  Buffer out;
  EXPECT_TRUE(encode_problem(u, out));
  return out;
}

/// The bytes are those of the generated class. Returns the message that it reads.
inline insula_lcm::haptic_problem_t expect_generated_form(const Buffer& bytes) {
  insula_lcm::haptic_problem_t message{};
  EXPECT_EQ(message.decode(bytes.data(), 0, int(bytes.size())), int(bytes.size()));
  Buffer theirs(std::size_t(message.getEncodedSize()));
  EXPECT_EQ(message.encode(theirs.data(), 0, int(theirs.size())), int(theirs.size()));
  EXPECT_EQ(bytes, theirs);
  return message;
}

inline void expect_equal(const HapticUpdate& a, const HapticUpdate& b) {
  EXPECT_EQ(a.session, b.session);
  EXPECT_EQ(a.sequence, b.sequence);
  EXPECT_EQ(a.time_us, b.time_us);
  EXPECT_EQ(a.pose_time_us, b.pose_time_us);
  EXPECT_EQ(a.step_s, b.step_s);
  EXPECT_EQ(a.sim_time_s, b.sim_time_s);
  const ConstraintProblem &p = a.problem, &r = b.problem;
  ASSERT_EQ(p.rows, r.rows);
  for (int i = 0; i < p.rows; ++i)
    for (int j = 0; j < p.rows; ++j) EXPECT_EQ(p.w_at(i, j), r.w_at(i, j));
  for_each_field(row_fields, [&](const auto& x, std::size_t index) {
    EXPECT_EQ(p.*x.values, r.*x.values) << "row field " << index;
  });
  EXPECT_EQ(p.step_s, r.step_s);
  EXPECT_EQ(p.prediction_horizon_steps, r.prediction_horizon_steps);
  ASSERT_EQ(p.blocks.size(), r.blocks.size());
  for (std::size_t i = 0; i < p.blocks.size(); ++i) EXPECT_TRUE(p.blocks[i] == r.blocks[i]) << "block " << i;
  ASSERT_EQ(p.tools.size(), r.tools.size());
  for (std::size_t i = 0; i < p.tools.size(); ++i) {
    const ToolTerms &x = p.tools[i], &y = r.tools[i];
    EXPECT_EQ(x.hand, y.hand);
    EXPECT_EQ(x.device.p, y.device.p);
    EXPECT_EQ(x.device.q.coeffs(), y.device.q.coeffs());
    EXPECT_EQ(x.swept_displacement, y.swept_displacement);
    EXPECT_EQ(x.free.p, y.free.p);
    EXPECT_EQ(x.free.q.coeffs(), y.free.q.coeffs());
    EXPECT_EQ(x.gain, y.gain);
    EXPECT_EQ(x.compliance, y.compliance);
    EXPECT_EQ(x.stiffness, y.stiffness);
    EXPECT_EQ(x.jacobian, y.jacobian);
    EXPECT_EQ(a.offset[i].p, b.offset[i].p);
    EXPECT_EQ(a.offset[i].q.coeffs(), b.offset[i].q.coeffs());
  }
}

/// Truncates and damages a message, with the right checksum. What is cut short is refused. After each random damage,
/// check(accepted, damaged, before, now, into) sees the update with its bytes before and after.
template <class Check>
void damage_message(const Buffer& whole, std::uint32_t seed, int times, Check&& check) {
  HapticUpdate into = make_update(2, 2, 1, 2);
  std::string why;
  for (std::size_t n = 0; n < whole.size(); ++n) {
    Buffer cut(whole.begin(), whole.begin() + std::ptrdiff_t(n));
    seal_problem(cut);
    ASSERT_FALSE(decode_problem(cut, into, why)) << n;
  }
  Buffer before = encoded(into), now;
  Mutator mutate(seed);
  for (int i = 0; i < times; ++i) {
    Buffer damaged = mutate(whole);
    seal_problem(damaged);
    const bool accepted = decode_problem(damaged, into, why);
    ASSERT_TRUE(encode_problem(into, now));
    ASSERT_NO_FATAL_FAILURE(check(accepted, damaged, before, now, into));
    before = now;
  }
}

inline void expect_sane(const HapticUpdate& u) {
  const ConstraintProblem& p = u.problem;
  ASSERT_LE(p.rows, max_problem_rows);
  int rows = 0;
  for (const Block& b : p.blocks) {
    ASSERT_EQ(b.row, rows);
    ASSERT_LE(b.lower, b.upper);
    ASSERT_TRUE(b.friction >= 0 && b.friction <= 10);
    const std::ptrdiff_t at = &b - p.blocks.data();
    ASSERT_TRUE(b.law == LawKind::patch ? b.normals >= 1 && b.normals <= at : b.normals == 0);
    for (std::ptrdiff_t i = at - b.normals; i < at; ++i) ASSERT_EQ(p.blocks[std::size_t(i)].law, LawKind::box);
    rows += b.rows();
  }
  ASSERT_EQ(rows, p.rows);
  for (int i = 0; i < p.rows; ++i) {
    ASSERT_GE(p.w_at(i, i), 0);
    ASSERT_LT(std::abs(p.delta_free[std::size_t(i)]), 1);
    for (int j = 0; j < p.rows; ++j) ASSERT_LT(std::abs(p.w_at(i, j)), 1e4);
  }
  ASSERT_LE(p.tools.size(), 2u);
  for (const ToolTerms& t : p.tools) {
    ASSERT_TRUE(t.hand == 0 || t.hand == 1);
    ASSERT_NEAR(t.device.q.norm(), 1, 1e-3);
    ASSERT_TRUE(t.gain.allFinite() && t.compliance.allFinite() && t.stiffness.allFinite() && t.jacobian.allFinite());
  }
}

}  // namespace insula::testing
