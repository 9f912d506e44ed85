// SPDX-License-Identifier: GPL-3.0-or-later
// The haptic problem's wire format: round trip, agreement with the generated class, and damage of every kind.
#include "core/haptics/haptic_update.h"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <insula_lcm/haptic_problem_t.hpp>

#include "core/bus/mutate_for_test.h"
#include "core/haptics/haptic_update_for_test.h"

namespace insula {
namespace {

using testing::Buffer;
using testing::encoded;
using testing::expect_equal;
using testing::expect_sane;
using testing::make_update;

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
  insula_lcm::haptic_problem_t message{};
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

TEST(HapticUpdate, AToolThatIsLeftOutIsNotInTheMessage) {
  const HapticUpdate all = make_update(7);
  ASSERT_EQ(all.problem.tools.size(), 2u);
  for (std::size_t t = 0; t < 2; ++t) {
    std::array<bool, 2> left_out{};
    left_out[std::size_t(all.problem.tools[t].hand)] = true;
    HapticUpdate rest = all;
    rest.problem.tools.erase(rest.problem.tools.begin() + std::ptrdiff_t(t));
    if (t == 0) rest.offset[0] = rest.offset[1];
    Buffer out;
    ASSERT_TRUE(encode_problem(all, all.problem, left_out, out));
    EXPECT_EQ(out, encoded(rest));
  }
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

TEST(HapticUpdate, RandomDamageNeverGetsThroughUnseen) {
  const Buffer whole = encoded(make_update(1, 2, 1, 1));
  HapticUpdate into = make_update(2, 2, 1, 2);
  Buffer before = encoded(into);
  testing::Mutator mutate(20240);
  int accepted = 0;
  std::string why;
  Buffer now;
  for (int i = 0; i < 1'000'000; ++i) {
    Buffer damaged = mutate(whole);
    seal_problem(damaged);  // the checksum alone would refuse all of them
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
  EXPECT_LT(accepted, 750'000);
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
      {"negative diagonal", [](auto& u) { u.problem.w[0] = -1e-3; }, "W has a negative diagonal"},
      {"nan delta", [=](auto& u) { u.problem.delta_free[2] = nan; }, "delta_free"},
      {"far delta", [](auto& u) { u.problem.delta_free[2] = -1.5; }, "delta_free"},
      {"infinite lambda", [](auto& u) { u.problem.lambda[0] = -infinite; }, "lambda"},
      {"nan rate", [=](auto& u) { u.problem.rate[1] = nan; }, "rate"},
      {"huge rate", [](auto& u) { u.problem.rate[1] = -2e3; }, "rate"},
      {"negative retardation time", [](auto& u) { u.problem.retardation_time[3] = -1e-3; }, "retardation time"},
      {"endless retardation time", [](auto& u) { u.problem.retardation_time[3] = infinite; }, "retardation time"},
      {"endless swept displacement", [](auto& u) { u.problem.tools[0].swept_displacement.x() = 1e9; },
       "swept displacement too long"},
      {"turned before the poses", [](auto& u) { u.problem.prediction_horizon_steps = -0.5; }, "time"},
      {"turned long after", [](auto& u) { u.problem.prediction_horizon_steps = infinite; }, "time"},
      {"turns round and round", [](auto& u) { u.problem.blocks[1].frame_rotation[2] = 7; }, "turn too far"},
      {"group -1", [](auto& u) { u.problem.blocks[0].failure_group = -1; }, "limit of failure"},
      {"fails after nan", [=](auto& u) { u.problem.blocks[1].failure_travel = float(nan); }, "limit of failure"},
      {"fails after -1 mm", [](auto& u) { u.problem.blocks[1].failure_travel = -1e-3F; }, "limit of failure"},
      {"fails at 1e9 N", [](auto& u) { u.problem.blocks[0].failure_force = 1e9F; }, "limit of failure"},
      {"nan turn", [=](auto& u) { u.problem.blocks[0].frame_rotation[0] = float(nan); }, "turn too far"},
      {"poses before time", [](auto& u) { u.pose_time_us = -1; }, "time"},
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
