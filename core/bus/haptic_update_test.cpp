// SPDX-License-Identifier: GPL-3.0-or-later
// The haptic problem's wire format: round trip, agreement with the generated class, and damage of every kind.
#include "core/bus/haptic_update.h"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <insula_lcm/haptic_problem_t.hpp>
#include <random>

#include "core/bus/mutate_for_test.h"

namespace insula {
namespace {

using Buffer = std::vector<std::uint8_t>;

Pose random_pose(std::mt19937& random) {
  std::normal_distribution<double> normal;
  Pose pose;
  pose.p = Vec3(normal(random), normal(random), normal(random)) * 0.1;
  pose.q = Quat(normal(random), normal(random), normal(random), normal(random)).normalized();
  return pose;
}

Mat6 random_symmetric(std::mt19937& random, double scale) {
  std::normal_distribution<double> normal;
  Mat6 a;
  for (int i = 0; i < 36; ++i) a.data()[i] = normal(random);
  return scale * (a * a.transpose());
}

/// A valid problem with friction and box blocks, float32 values where the wire has float32.
HapticUpdate make_update(unsigned seed, int boxes = 4, int contacts = 3, int tools = 2) {
  std::mt19937 random(seed);
  std::normal_distribution<double> normal;
  HapticUpdate u;
  u.session = 1234567890123;
  u.sequence = 77;
  u.time_us = 987654321;
  u.step_s = 1.0 / 60;
  u.sim_time_s = 3.25;
  ConstraintProblem& p = u.problem;
  const int n = boxes + 3 * contacts;
  p.resize(n);
  for (int i = 0; i < n; ++i)
    for (int j = 0; j <= i; ++j) {
      const double w = double(float(i == j ? 1e-3 + std::abs(normal(random)) * 1e-3 : normal(random) * 1e-5));
      p.w[std::size_t(i * p.stride + j)] = p.w[std::size_t(j * p.stride + i)] = w;
    }
  for (int i = 0; i < n; ++i) p.delta_free[std::size_t(i)] = normal(random) * 1e-3;
  int row = 0;
  for (int k = 0; k < boxes + contacts; ++k) {
    Block b;
    b.id = 0xfedc000000000000u + std::uint64_t(1000 + k * 7);
    b.row = row;
    if (k % 2 == 1 && contacts > 0) {
      --contacts;
      ++boxes;  // keeps k's bound
      b.law = LawKind::friction;
      b.friction = double(0.3f);
      p.lambda[std::size_t(row)] = 0.5;
      p.lambda[std::size_t(row + 1)] = 0.1;
      p.lambda[std::size_t(row + 2)] = -0.1;
    } else {
      b.compliance = double(0.02f);
      if (k % 4 == 0) b.upper = 0;
      p.lambda[std::size_t(row)] = -std::abs(normal(random));
    }
    p.blocks.push_back(b);
    row += b.rows();
    if (row >= n) break;
  }
  for (int t = 0; t < tools; ++t) {
    ToolTerms tool;
    tool.hand = 1 - t;
    tool.device = random_pose(random);
    tool.free = random_pose(random);
    tool.gain = random_symmetric(random, 0.01);
    tool.gain(0, 5) += 0.5;  // a gain need not be symmetric
    tool.compliance = random_symmetric(random, 1e-3);
    tool.stiffness = random_symmetric(random, 100);
    tool.jacobian.resize(n, 6);
    for (int i = 0; i < n * 6; ++i) tool.jacobian.data()[i] = double(float(normal(random)));
    p.tools.push_back(tool);
    u.offset[std::size_t(t)] = random_pose(random);
  }
  return u;
}

Buffer encoded(const HapticUpdate& u) {
  Buffer out;
  EXPECT_TRUE(encode_problem(u, out));
  return out;
}

void expect_equal(const HapticUpdate& a, const HapticUpdate& b) {
  EXPECT_EQ(a.session, b.session);
  EXPECT_EQ(a.sequence, b.sequence);
  EXPECT_EQ(a.time_us, b.time_us);
  EXPECT_EQ(a.step_s, b.step_s);
  EXPECT_EQ(a.sim_time_s, b.sim_time_s);
  const ConstraintProblem &p = a.problem, &r = b.problem;
  ASSERT_EQ(p.rows, r.rows);
  for (int i = 0; i < p.rows; ++i)
    for (int j = 0; j < p.rows; ++j) EXPECT_EQ(p.w_at(i, j), r.w_at(i, j));
  EXPECT_EQ(p.delta_free, r.delta_free);
  EXPECT_EQ(p.lambda, r.lambda);
  ASSERT_EQ(p.blocks.size(), r.blocks.size());
  for (std::size_t i = 0; i < p.blocks.size(); ++i) {
    const Block &x = p.blocks[i], &y = r.blocks[i];
    EXPECT_EQ(x.id, y.id);
    EXPECT_EQ(x.row, y.row);
    EXPECT_EQ(x.law, y.law);
    EXPECT_EQ(x.compliance, y.compliance);
    EXPECT_EQ(x.lower, y.lower);
    EXPECT_EQ(x.upper, y.upper);
    EXPECT_EQ(x.friction, y.friction);
  }
  ASSERT_EQ(p.tools.size(), r.tools.size());
  for (std::size_t i = 0; i < p.tools.size(); ++i) {
    const ToolTerms &x = p.tools[i], &y = r.tools[i];
    EXPECT_EQ(x.hand, y.hand);
    EXPECT_EQ(x.device.p, y.device.p);
    EXPECT_EQ(x.device.q.coeffs(), y.device.q.coeffs());
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

TEST(HapticUpdate, RoundTripIsExact) {
  for (const auto& [boxes, contacts, tools] : {std::tuple{4, 3, 2}, {1, 0, 1}, {0, 0, 0}, {0, 0, 2}, {60, 60, 2}}) {
    const HapticUpdate sent = make_update(3, boxes, contacts, tools);
    HapticUpdate got;
    std::string why;
    ASSERT_TRUE(decode_problem(encoded(sent), got, why)) << why;
    expect_equal(sent, got);
  }
}

TEST(HapticUpdate, BytesAreThoseOfTheGeneratedClass) {
  const Buffer ours = encoded(make_update(5));
  insula_lcm::haptic_problem_t message;
  ASSERT_EQ(message.decode(ours.data(), 0, int(ours.size())), int(ours.size()));
  EXPECT_EQ(message.rows, 13);
  EXPECT_EQ(message.tools, 2);
  EXPECT_EQ(message.block_friction.size(), std::size_t(message.blocks));
  EXPECT_EQ(message.tool[0].hand, 1);
  Buffer theirs(std::size_t(message.getEncodedSize()));
  ASSERT_EQ(message.encode(theirs.data(), 0, int(theirs.size())), int(theirs.size()));
  EXPECT_EQ(ours, theirs);
  HapticUpdate back;
  std::string why;
  ASSERT_TRUE(decode_problem(theirs, back, why)) << why;
  EXPECT_EQ(back.problem.lambda[0], message.lambda_N[0]);
  EXPECT_EQ(back.problem.tools[1].stiffness(2, 3), message.tool[1].stiffness[15]);
  EXPECT_EQ(back.offset[1].p.z(), message.tool[1].offset_p_m[2]);
}

TEST(HapticUpdate, WidestProblemFits) {
  HapticUpdate boxes_only = make_update(9, 240, 0, 2);
  EXPECT_EQ(boxes_only.problem.rows, max_problem_rows);
  Buffer out;
  std::string why;
  HapticUpdate got;
  ASSERT_TRUE(encode_problem(boxes_only, out));
  EXPECT_TRUE(decode_problem(out, got, why)) << why;
  boxes_only.problem.resize(241);
  EXPECT_FALSE(encode_problem(boxes_only, out));
  EXPECT_TRUE(out.empty());
}

TEST(HapticUpdate, EveryTruncationIsRefusedAndChangesNothing) {
  const Buffer whole = encoded(make_update(1));
  HapticUpdate into = make_update(2);
  const Buffer before = encoded(into);
  for (std::size_t n = 0; n < whole.size(); ++n) {
    std::string why;
    // A buffer of its own with exactly n bytes: a read past its end is visible to the address sanitizer.
    const Buffer cut(whole.begin(), whole.begin() + std::ptrdiff_t(n));
    ASSERT_FALSE(decode_problem(cut, into, why)) << n;
    ASSERT_FALSE(why.empty());
  }
  EXPECT_EQ(encoded(into), before);
  Buffer longer = whole;
  longer.push_back(0);
  std::string why;
  EXPECT_FALSE(decode_problem(longer, into, why));
}

void expect_sane(const HapticUpdate& u) {
  const ConstraintProblem& p = u.problem;
  ASSERT_LE(p.rows, max_problem_rows);
  int rows = 0;
  for (const Block& b : p.blocks) {
    ASSERT_EQ(b.row, rows);
    ASSERT_LE(b.lower, b.upper);
    ASSERT_TRUE(b.friction >= 0 && b.friction <= 10);
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

TEST(HapticUpdate, RandomDamageNeverGetsThroughUnseen) {
  const Buffer whole = encoded(make_update(1, 2, 1, 1));
  HapticUpdate into = make_update(2, 2, 1, 2);
  Buffer before = encoded(into);
  testing::Mutator mutate(20240);
  int accepted = 0;
  std::string why;
  Buffer now;
  for (int i = 0; i < 200'000; ++i) {
    const Buffer damaged = mutate(whole);
    const bool ok = decode_problem(damaged, into, why);
    ASSERT_TRUE(encode_problem(into, now));
    if (ok) {
      ++accepted;
      ASSERT_NO_FATAL_FAILURE(expect_sane(into));
      ASSERT_EQ(now, damaged);  // what was accepted is what was said
      before = now;
    } else {
      ASSERT_EQ(now, before);
    }
  }
  EXPECT_GT(accepted, 0);  // some damage is harmless: another plausible number
  EXPECT_LT(accepted, 150'000);
}

struct Fault {
  const char* name;
  std::function<void(HapticUpdate&)> make;
  const char* reason;
};

TEST(HapticUpdate, EachRuleHasItsReason) {
  const double nan = std::nan("");
  const std::vector<Fault> faults = {
      {"nan W", [=](auto& u) { u.problem.w[0] = nan; }, "W not finite"},
      {"huge W", [](auto& u) { u.problem.w[0] = 2e4; }, "W not finite"},
      {"negative diagonal", [](auto& u) { u.problem.w[0] = -1e-3; }, "W not finite"},
      {"nan delta", [=](auto& u) { u.problem.delta_free[2] = nan; }, "delta_free"},
      {"far delta", [](auto& u) { u.problem.delta_free[2] = -1.5; }, "delta_free"},
      {"infinite lambda", [](auto& u) { u.problem.lambda[0] = -infinite; }, "lambda"},
      {"lambda out of box", [](auto& u) { u.problem.lambda[0] = 1; }, "lambda outside its law"},
      {"pulling contact", [](auto& u) { u.problem.lambda[1] = -1; }, "lambda outside its law"},
      {"outside the cone", [](auto& u) { u.problem.lambda[2] = 5; }, "lambda outside its law"},
      {"twice the id", [](auto& u) { u.problem.blocks[3].id = u.problem.blocks[0].id; }, "the same block id"},
      {"row gap", [](auto& u) { u.problem.blocks[2].row += 1; }, "cover the rows"},
      {"rows left", [](auto& u) { u.problem.blocks.pop_back(); }, "cover the rows"},
      {"crossed bounds", [](auto& u) { u.problem.blocks[0].lower = 1; }, "no interval"},
      {"nan bound", [=](auto& u) { u.problem.blocks[0].upper = nan; }, "no interval"},
      {"friction", [](auto& u) { u.problem.blocks[1].friction = 11; }, "friction out of range"},
      {"negative friction", [](auto& u) { u.problem.blocks[1].friction = -0.1; }, "friction out of range"},
      {"negative compliance", [](auto& u) { u.problem.blocks[0].compliance = -1; }, "compliance out of range"},
      {"hand 2", [](auto& u) { u.problem.tools[0].hand = 2; }, "hand"},
      {"one hand twice", [](auto& u) { u.problem.tools[1].hand = u.problem.tools[0].hand; }, "hand"},
      {"quaternion", [](auto& u) { u.problem.tools[0].device.q.coeffs() *= 1.01; }, "pose"},
      {"nan pose", [=](auto& u) { u.problem.tools[1].free.p.y() = nan; }, "pose"},
      {"nan offset", [=](auto& u) { u.offset[0].p.x() = nan; }, "pose"},
      {"nan gain", [=](auto& u) { u.problem.tools[0].gain(3, 3) = nan; }, "gain"},
      {"lopsided compliance", [](auto& u) { u.problem.tools[0].compliance(0, 3) += 1; }, "compliance"},
      {"negative compliance diagonal", [](auto& u) { u.problem.tools[0].compliance(2, 2) = -1; }, "compliance"},
      {"lopsided stiffness", [](auto& u) { u.problem.tools[1].stiffness(5, 1) -= 500; }, "stiffness"},
      {"infinite Jacobian", [](auto& u) { u.problem.tools[1].jacobian(1, 1) = infinite; }, "Jacobian"},
      {"no step", [](auto& u) { u.step_s = 0; }, "step"},
      {"nan time", [=](auto& u) { u.sim_time_s = nan; }, "time"},
  };
  for (const Fault& fault : faults) {
    HapticUpdate u = make_update(4), into;
    std::string why;
    ASSERT_TRUE(decode_problem(encoded(u), into, why)) << why;
    fault.make(u);
    EXPECT_FALSE(decode_problem(encoded(u), into, why)) << fault.name;
    EXPECT_NE(why.find(fault.reason), std::string::npos) << fault.name << ": " << why;
  }
}

TEST(HapticUpdate, BuffersAreReused) {
  HapticUpdate into;
  std::string why;
  Buffer out;
  ASSERT_TRUE(encode_problem(make_update(1), out));
  ASSERT_TRUE(decode_problem(out, into, why));
  const auto* bytes = out.data();
  const auto* w = into.problem.w.data();
  const auto* blocks = into.problem.blocks.data();
  const auto* jacobian = into.problem.tools[1].jacobian.data();
  const HapticUpdate next = make_update(2);
  ASSERT_TRUE(encode_problem(next, out));
  ASSERT_TRUE(decode_problem(out, into, why));
  EXPECT_EQ(out.data(), bytes);
  EXPECT_EQ(into.problem.w.data(), w);
  EXPECT_EQ(into.problem.blocks.data(), blocks);
  EXPECT_EQ(into.problem.tools[1].jacobian.data(), jacobian);
  expect_equal(into, next);
}

}  // namespace
}  // namespace insula
