// SPDX-License-Identifier: GPL-3.0-or-later
// Cutting down a problem with a tool that carries a clip.
#include <gtest/gtest.h>

#include <algorithm>
#include <cstdio>

#include "core/haptics/condense.h"
#include "core/haptics/weld_elimination.h"
#include "haptic_server/servo.h"
#include "haptic_server/welded_problem_for_test.h"

namespace insula {
namespace {

using testing::Random;

/// 110 rows of a tool and its clip, and as many again that neither touches, of tissue that joins them all. The others
/// are nearer to another state than the clip's contacts are.
ConstraintProblem clip_among_others(std::uint64_t seed) {
  constexpr int own = 4, contacts = 100, others = 110, soft = 30;
  const ConstraintProblem clip = testing::with_clip(contacts, own, seed);
  const int n = clip.rows, all = n + others;
  ConstraintProblem p;
  p.resize(all);
  p.step_s = clip.step_s;
  p.blocks = clip.blocks;
  p.tools = clip.tools;
  p.tools[0].jacobian.setZero(all, 6);
  p.tools[0].jacobian.topRows(n) = clip.tools[0].jacobian;
  Random random(seed + 1);
  MatX shape(all, soft);
  for (int i = 0; i < all; ++i)
    for (int k = 0; k < soft; ++k)
      shape(i, k) = random.next() * (i >= own && i < own + weld_rows ? 0 : i < n ? 1e-2 : 3e-2);
  const MatX tissue = shape * shape.transpose();
  for (int i = 0; i < all; ++i) {
    for (int j = 0; j < all; ++j)
      p.w[std::size_t(i) * std::size_t(p.stride) + std::size_t(j)] = tissue(i, j) + (i < n && j < n ? clip.w_at(i, j)
                                                                                     : i == j       ? 4e-3
                                                                                                    : 0.0);
    p.retardation_time[std::size_t(i)] = i >= own && i < own + weld_rows ? 0 : 0.02;
    p.delta_free[std::size_t(i)] = i < n ? clip.delta_free[std::size_t(i)] : -1e-5;
    if (i >= n) p.blocks.push_back({.id = std::uint64_t(5000 + i), .row = i, .lower = 0});
  }
  SolveWorkspace ws;
  ws.reserve(all);
  ws.lambda.assign(std::size_t(all), 0.0);
  solve(p, p.delta_free, {.max_sweeps = 3000, .tolerance_m = 1e-17, .max_newton = 40}, ws);
  p.lambda = ws.lambda;
  return p;
}

// For any number of rows, the contacts of a grasped clip are neither part of its mass nor held.
TEST(CondenseWeld, ContactsOfAGraspedClipAreKept) {
  const ConstraintProblem full = clip_among_others(21);
  ASSERT_EQ(first_weld_row(full, 0), 4);
  ConstraintProblem small;
  Condenser()(full, 114, small);
  ASSERT_LE(small.rows, 114);
  for (int b = 0; b < 110; ++b)  // the first 110 blocks have a row each
    EXPECT_TRUE(std::any_of(small.blocks.begin(), small.blocks.end(), [&](const Block& s) {
      return s.id == full.blocks[std::size_t(b)].id;
    })) << b;
  // The six rows come along even where not all that is felt does, or there would be no telling what the clip is.
  ConstraintProblem tiny;
  Condenser()(full, 30, tiny);
  EXPECT_GE(first_weld_row(tiny, 0), 0);
  // Both problems from tick to tick, the clip drawn off what it presses.
  ServoSettings settings = ServoSettings::beyond_equation_7();
  settings.force_crossfade.within_s = 0;
  settings.max_sweeps = 3000;
  settings.max_operations = 1e12;
  settings.tolerance_m = 1e-12;
  Servo whole(settings), cut(settings);
  whole.set_problem(&full, {}, 1e-3);
  cut.set_problem(&small, {}, 1e-3);
  double most = 0, apart = 0;
  ServoInput in;
  in.connected[1] = true;
  for (int k = 1; k <= 20; ++k) {
    in.device[1].p = Vec3(2e-6, 0, 4e-6) * k;
    const Vec3 a = whole.tick(in).hand[1].force, b = cut.tick(in).hand[1].force;
    most = std::max(most, a.norm());
    apart = std::max(apart, (a - b).norm());
  }
  std::printf("a grasped clip among rows that are condensed: %.2e N of %.2e N\n", apart, most);
  EXPECT_GT(most, 0.01);
  EXPECT_LT(apart, 0.02 * most);
}

}  // namespace
}  // namespace insula
