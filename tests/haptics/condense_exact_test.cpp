// SPDX-License-Identifier: GPL-3.0-or-later
// What the tools feel of a condensed problem against the whole one, with the devices away from where it was built.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "core/haptics/condense.h"
#include "core/haptics/condense_for_test.h"
#include "core/haptics/haptic_update.h"
#include "core/testing/count_allocations.h"
#include "engine/live/publisher.h"
#include "haptic_server/problem_for_test.h"
#include "haptic_server/servo.h"

namespace insula {
namespace {

using testing::Random;
using testing::Wrenches;
constexpr int all_rows = 360, max_rows = 206;

/// 360 rows: `contacts` of three rows, 16 patches of five, the rest fibres. A tool touches the first twenty contacts,
/// four patches and six fibres. Where none does, friction is `sticky`; of the other fibres `unbounded` have laws
/// without bounds, every second of them bilateral.
ConstraintProblem problem(int contacts, int unbounded, std::uint64_t seed, double sticky = 0.3) {
  const int patches = 16, fibres = all_rows - 3 * contacts - 5 * patches;
  ConstraintProblem p = testing::two_tool_problem(contacts, fibres, seed, patches);
  int fibre = 0, patch_row = 0;
  for (Block& b : p.blocks) {
    bool tool_coupled = b.row < 60;
    if (b.id >= 5000 && b.id < 9000) {
      tool_coupled = fibre++ < 6;
      if (!tool_coupled && fibre - 6 <= unbounded) {
        b.upper = infinite;
        if (fibre % 2) b.compliance = 0;
      }
    } else if (b.id >= 9000) {
      tool_coupled = patch_row++ < 16;  // four blocks a patch
    }
    if (!tool_coupled && b.law != LawKind::box) b.friction = sticky;
    for (int k = 0; k < b.rows() && !tool_coupled; ++k)
      for (ToolTerms& t : p.tools) t.jacobian.row(b.row + k).setZero();
  }
  return p;
}

constexpr SolveSettings well{.max_sweeps = 3000, .tolerance_m = 1e-17, .max_newton = 40};

void solve_well(const ConstraintProblem& p, const std::vector<double>& delta_free, std::vector<double>& lambda) {
  SolveWorkspace ws;
  ws.reserve(p.rows);
  ws.lambda = lambda;
  solve(p, delta_free, well, ws);
  lambda = ws.lambda;
}

Wrenches hand_wrenches(const ConstraintProblem& p, const Wrenches& d) { return testing::hand_wrenches(p, d, well); }

Wrenches moved(Random& random, double size_m) {
  Wrenches d;
  for (Vec6& v : d) v << random.vector(size_m), random.vector(size_m / 0.02);
  return d;
}

/// Newtons, moments counted at a lever of 2 cm.
double apart(const Wrenches& a, const Wrenches& b) {
  double most = 0;
  for (std::size_t t = 0; t < 2; ++t)
    most = std::max({most, (a[t] - b[t]).head<3>().norm(), (a[t] - b[t]).tail<3>().norm() / 0.02});
  return most;
}

TEST(CondenseExact, RowsWithoutBoundsAreEliminatedExactlyWhereverTheToolsGo) {
  // 40 contacts, 16 patches and the 6 fibres that are felt fit; everything else is linear.
  ConstraintProblem full = problem(40, 154, 7);
  solve_well(full, full.delta_free, full.lambda);
  ConstraintProblem small;
  Condenser()(full, max_rows, small);
  ASSERT_EQ(small.rows, max_rows);
  Random random(3);
  for (int k = 0; k < 12; ++k) {
    const Wrenches d = moved(random, k < 8 ? 1e-3 : 1e-2);
    const Wrenches whole = hand_wrenches(full, d);
    EXPECT_GT(whole[0].norm(), 0.01);
    EXPECT_LT(apart(whole, hand_wrenches(small, d)), 1e-9) << k;
  }
}

// A contact that only repeats a bilateral row cannot move once that is eliminated: rounding leaves a compliance of
// either sign.
TEST(CondenseExact, RowsThatHangOnEliminatedOnesHoldStill) {
  int hanging = 0;
  for (std::uint64_t seed : {7, 8, 9, 10}) {
    ConstraintProblem full = problem(40, 154, seed);
    const Block* bilateral = nullptr;
    for (const Block& b : full.blocks)
      if (b.law == LawKind::box && b.upper == infinite && b.lower == -infinite && b.compliance == 0) bilateral = &b;
    ASSERT_TRUE(bilateral);
    const std::size_t from = std::size_t(bilateral->row), stride = std::size_t(full.stride);
    for (std::size_t to : {60u, 75u, 90u, 105u}) {  // normals of contacts that no tool touches
      for (std::size_t c = 0; c < std::size_t(full.rows); ++c) full.w[to * stride + c] = full.w[from * stride + c];
      for (std::size_t r = 0; r < std::size_t(full.rows); ++r) full.w[r * stride + to] = full.w[r * stride + from];
      full.w[to * stride + to] = full.w[from * stride + from];
      full.delta_free[to] = full.delta_free[from];
    }
    for (Block& b : full.blocks)
      if (b.row >= 60 && b.law == LawKind::friction)
        b.friction = 0;  // how two that share a load divide it is open, and so is their friction
    solve_well(full, full.delta_free, full.lambda);
    ConstraintProblem small;
    Condenser()(full, max_rows, small);
    ASSERT_EQ(small.rows, max_rows);
    for (int i = 0; i < small.rows; ++i) {
      ASSERT_GE(small.w_at(i, i), 0) << i;
      hanging += small.w_at(i, i) == 0;
      for (int j = 0; j < small.rows && small.w_at(i, i) == 0; ++j) ASSERT_EQ(small.w_at(i, j), 0) << i << ' ' << j;
    }
    Random random(seed);
    for (int k = 0; k < 3; ++k) {
      const Wrenches d = moved(random, 1e-3);
      EXPECT_LT(apart(hand_wrenches(full, d), hand_wrenches(small, d)), 1e-7) << seed << ' ' << k;
    }
  }
  EXPECT_EQ(hanging, 16);
}

TEST(CondenseExact, MixedStatesAreExactUntilOneChanges) {
  ConstraintProblem full = problem(60, 50, 11, 1.5);
  solve_well(full, full.delta_free, full.lambda);
  ConstraintProblem small;
  Condenser()(full, max_rows, small);
  ASSERT_LE(small.rows, max_rows);
  ASSERT_GT(small.rows, max_rows - 5);
  // All others held, which is what was done before there was an elimination.
  ConstraintProblem held = small;
  for (int i = 0; i < small.rows; ++i) {
    const auto original = [&](int row) {
      for (const Block& s : small.blocks)
        if (row >= s.row && row < s.row + s.rows())
          for (const Block& b : full.blocks)
            if (b.id == s.id) return b.row + row - s.row;
      return -1;
    };
    held.delta_free[std::size_t(i)] = full.delta_free[std::size_t(original(i))];
    for (int c = 0; c < full.rows; ++c)
      held.delta_free[std::size_t(i)] += full.w_at(original(i), c) * full.lambda[std::size_t(c)];
    for (int j = 0; j < small.rows; ++j) {
      held.w[std::size_t(i) * std::size_t(held.stride) + std::size_t(j)] = full.w_at(original(i), original(j));
      held.delta_free[std::size_t(i)] -= full.w_at(original(i), original(j)) * small.lambda[std::size_t(j)];
    }
  }
  Random random(4);
  double far = 0, far_held = 0, change = 0;
  const Wrenches rest = hand_wrenches(full, {Vec6::Zero(), Vec6::Zero()});
  EXPECT_LT(apart(rest, hand_wrenches(small, {Vec6::Zero(), Vec6::Zero()})), 1e-9);
  for (int k = 0; k < 10; ++k) {
    const Wrenches near = moved(random, 2e-7);
    EXPECT_LT(apart(hand_wrenches(full, near), hand_wrenches(small, near)), 1e-9) << k;
    const Wrenches d = moved(random, 1e-3), whole = hand_wrenches(full, d);
    far = std::max(far, apart(whole, hand_wrenches(small, d)));
    far_held = std::max(far_held, apart(whole, hand_wrenches(held, d)));
    change = std::max(change, apart(whole, rest));
  }
  std::printf("a millimetre away: %.2e N of a change of %.2e N, held %.2e N\n", far, change, far_held);
  EXPECT_LT(far, 0.02 * change);
  EXPECT_LT(far, 0.5 * far_held);
}

/// Where no tool touches, what presses is given (a lower and an upper bound of one size), and friction of that strength
/// slips.
ConstraintProblem slipping(std::uint64_t seed) {
  ConstraintProblem p = problem(20, 214, seed);
  int pressing = 0;
  for (Block& b : p.blocks) {
    if (b.id < 9016) continue;  // the patches that no tool touches
    if (b.law == LawKind::box) b.lower = b.upper = 0.02 + 0.005 * (pressing++ % 5);
    else b.friction = 0.05;
  }
  return p;
}

// The direction across a slip turns with it; along it the force stays while what presses does. So only the curvature of
// the cone is left.
TEST(CondenseExact, FrictionThatSlipsTurnsWithItsSlip) {
  for (const std::uint64_t seed : {13, 14, 15}) {
    ConstraintProblem full = slipping(seed);
    solve_well(full, full.delta_free, full.lambda);
    int slips = 0;
    for (const Block& b : full.blocks) {
      if (b.law != LawKind::patch || b.friction != 0.05) continue;
      double pressed = 0;
      for (int i = 1; i <= 3; ++i) pressed += full.lambda[std::size_t(b.row - i)];
      slips += std::hypot(full.lambda[std::size_t(b.row)], full.lambda[std::size_t(b.row + 1)]) >
               (1 - 1e-9) * b.friction * pressed;
    }
    ASSERT_GE(slips, 10);
    ConstraintProblem small;
    Condenser()(full, 90, small);  // 86 are felt
    ASSERT_LE(small.rows, 90);
    Random random(seed);
    const Wrenches rest = hand_wrenches(full, {Vec6::Zero(), Vec6::Zero()});
    EXPECT_LT(apart(rest, hand_wrenches(small, {Vec6::Zero(), Vec6::Zero()})), 1e-9);
    Wrenches d = moved(random, 1e-5);
    double off[3], change = 0;
    for (int k = 0; k < 3; ++k) {
      const Wrenches whole = hand_wrenches(full, d);
      if (k == 0) change = apart(whole, rest);
      off[k] = apart(whole, hand_wrenches(small, d));
      for (Vec6& v : d) v *= 0.1;
    }
    std::printf("slips %d: change %.2e, off %.2e %.2e %.2e\n", slips, change, off[0], off[1], off[2]);
    EXPECT_LT(off[0], 1e-2 * change);
    EXPECT_LT(off[1], 0.05 * off[0]);  // quadratic
    EXPECT_LT(off[1], 1e-8);
  }
}

TEST(CondenseExact, RowsThatHangOnOthersAreHeld) {
  // The same bilateral row three times: W_EE is singular.
  ConstraintProblem full = problem(40, 154, 9);
  std::vector<int> twins;
  for (const Block& b : full.blocks)
    if (b.upper == infinite && b.law == LawKind::box && b.compliance == 0 && twins.size() < 3 && b.lower == -infinite)
      twins.push_back(b.row);
  ASSERT_EQ(twins.size(), 3u);
  const auto w = [&](int i, int j) -> double& {
    return full.w[std::size_t(i) * std::size_t(full.stride) + std::size_t(j)];
  };
  for (std::size_t k = 1; k < 3; ++k) {
    for (int j = 0; j < full.rows; ++j) w(twins[k], j) = w(twins[0], j);
    for (int j = 0; j < full.rows; ++j) w(j, twins[k]) = w(j, twins[0]);
    full.delta_free[std::size_t(twins[k])] = full.delta_free[std::size_t(twins[0])];
  }
  solve_well(full, full.delta_free, full.lambda);
  ConstraintProblem small;
  Condenser()(full, max_rows, small);
  Random random(5);
  for (int k = 0; k < 4; ++k) {
    const Wrenches d = moved(random, 1e-3);
    EXPECT_LT(apart(hand_wrenches(full, d), hand_wrenches(small, d)), 1e-7) << k;
  }
}

TEST(CondenseExact, ThreeHundredAndSixtyRowsAreServedOverTheBus) {
  ConstraintProblem full = problem(60, 50, 11, 1.5);
  solve_well(full, full.delta_free, full.lambda);
  HapticUpdate sent, got;
  sent.step_s = 0.016;
  Condenser()(full, Publisher::max_rows, sent.problem);
  std::vector<std::uint8_t> bytes;
  std::string why;
  ASSERT_TRUE(encode_problem(sent, bytes));
  EXPECT_LT(bytes.size(), 120'000u);
  ASSERT_TRUE(decode_problem(bytes, got, why)) << why;
  Servo servo;
  servo.set_problem(&got.problem);
  Random random(6);
  for (int k = 0; k < 5; ++k) {
    const Wrenches d = moved(random, 2e-4), whole = hand_wrenches(full, d);
    ServoInput input;
    input.connected = {true, true};
    for (std::size_t t = 0; t < 2; ++t) input.device[t] = displaced(full.tools[t].device, d[t]);
    ServoResult result;
    for (int tick = 0; tick < 5; ++tick)
      result = servo.tick(input);  // a hand moves less in a tick than from one k to the next
    for (std::size_t t = 0; t < 2; ++t) {
      ASSERT_TRUE(result.hand[t].valid);
      EXPECT_LT((result.hand[t].force - whole[t].head<3>()).norm(), 0.02 * whole[t].head<3>().norm()) << k;
    }
  }
}

TEST(CondenseExact, AllocatesNothingOnceItHasItsSize) {
  ConstraintProblem full = problem(60, 50, 11), small;
  solve_well(full, full.delta_free, full.lambda);
  Condenser condense;
  condense(full, max_rows, small);
  const long before = allocations;
  condense(full, max_rows, small);
  EXPECT_EQ(allocations - before, 0);
}

}  // namespace
}  // namespace insula
