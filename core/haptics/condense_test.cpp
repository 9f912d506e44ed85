// SPDX-License-Identifier: GPL-3.0-or-later
// Cutting a problem down keeps what the tools feel.
#include "core/haptics/condense.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <random>

#include "core/constraint/problem_for_test.h"
#include "core/constraint/solve.h"

namespace insula {
namespace {

// n box rows with a dense positive W; the tool touches the first `felt`.
ConstraintProblem make(int n, int tool_coupled) {
  std::mt19937 random(3);
  std::uniform_real_distribution<double> u(-1, 1);
  ConstraintProblem p;
  p.resize(n);
  const MatX a = MatX::NullaryExpr(n, n, [&] { return u(random); });
  const MatX w = a * a.transpose() / n + 0.5 * MatX::Identity(n, n);
  testing::set_w(p, w);
  for (int i = 0; i < n; ++i) {
    p.delta_free[std::size_t(i)] = 1e-3 * u(random);
    Block b;
    b.id = std::uint64_t(100 + i);
    b.row = i;
    b.lower = 0;
    p.blocks.push_back(b);
  }
  ToolTerms tool;
  tool.jacobian.setZero(n, 6);
  for (int i = 0; i < tool_coupled; ++i) tool.jacobian.row(i).setConstant(1.0 + i);
  p.tools.push_back(tool);
  SolveWorkspace ws;
  ws.lambda.assign(std::size_t(n), 0.0);
  solve(p, p.delta_free, {5000, 1e-15}, ws);
  p.lambda = ws.lambda;
  return p;
}

TEST(Condense, SmallProblemsAreNotCopied) {
  const ConstraintProblem full = make(12, 3);
  ConstraintProblem small;
  Condenser condense;
  EXPECT_EQ(&condense(full, 12, small), &full);
  EXPECT_EQ(small.rows, 0);
  EXPECT_EQ(&condense(full, 11, small), &small);
  EXPECT_EQ(small.rows, 11);
}

TEST(Condense, KeepsTheToolCoupledRowsAndTheirSolution) {
  const ConstraintProblem full = make(60, 7);
  ConstraintProblem small;
  Condenser()(full, 20, small);
  ASSERT_EQ(small.rows, 20);
  ASSERT_EQ(small.blocks.size(), 20u);
  for (int i = 0; i < 7; ++i) {  // tool-coupled rows are kept, in their order
    EXPECT_EQ(small.blocks[std::size_t(i)].id, std::uint64_t(100 + i));
    EXPECT_EQ(small.blocks[std::size_t(i)].row, i);
    EXPECT_TRUE(small.tools[0].jacobian.row(i) == full.tools[0].jacobian.row(i));
  }
  // Solved from nothing, the small problem gives the forces of the full one.
  SolveWorkspace ws;
  ws.lambda.assign(20, 0.0);
  solve(small, small.delta_free, {5000, 1e-15}, ws);
  for (std::size_t i = 0; i < 20; ++i) {
    const std::size_t row = std::size_t(small.blocks[i].id - 100);
    EXPECT_NEAR(ws.lambda[i], full.lambda[row], 1e-12);
    EXPECT_EQ(small.lambda[i], full.lambda[row]);
  }
}

TEST(Condense, NeverSplitsAContact) {
  ConstraintProblem full = make(60, 3);
  full.blocks.clear();
  for (int r = 0; r < 60; r += 3) {
    Block b;
    b.id = std::uint64_t(r);
    b.row = r;
    b.law = LawKind::friction;
    b.friction = 0.2;
    full.blocks.push_back(b);
  }
  ConstraintProblem small;
  Condenser()(full, 20, small);
  EXPECT_EQ(small.rows, 18);
  EXPECT_EQ(small.blocks.size(), 6u);
}

// Twelve patches of three contacts; what is felt of each is one row: a contact, a tangent, or nothing.
ConstraintProblem patches(bool tool_coupled_tangents) {
  ConstraintProblem full = make(60, 0);
  full.blocks.clear();
  for (int patch = 0; patch < 12; ++patch)
    for (int k = 0; k < 4; ++k) {
      Block b;
      b.id = std::uint64_t(10 * patch + k);
      b.row = 5 * patch + k;
      if (k < 3) {
        b.lower = 0;
      } else {
        b.law = LawKind::patch;
        b.friction = 0.3;
        b.normals = 3;
      }
      full.blocks.push_back(b);
    }
  for (const int patch : {2, 7, 11})
    full.tools[0].jacobian.row(5 * patch + (tool_coupled_tangents ? 4 : 1)).setConstant(1.0);
  SolveWorkspace ws;
  ws.lambda.assign(60, 0.0);
  solve(full, full.delta_free, {5000, 1e-15}, ws);
  full.lambda = ws.lambda;
  return full;
}

TEST(Condense, APatchIsKeptOrLeftOutTogetherWithItsContacts) {
  for (const bool tool_coupled_tangents : {false, true})
    for (int most = 4; most < 60; ++most) {
      const ConstraintProblem full = patches(tool_coupled_tangents);
      ConstraintProblem small;
      Condenser()(full, most, small);
      ASSERT_EQ(small.rows, 5 * (most / 5));
      ASSERT_EQ(small.blocks.size(), std::size_t(4 * (most / 5)));
      for (std::size_t i = 0; i < small.blocks.size(); ++i) {
        const Block& b = small.blocks[i];
        EXPECT_EQ(b.id % 10, i % 4) << "contacts and patches out of order";
        EXPECT_EQ(b.id / 10, small.blocks[i / 4 * 4].id / 10) << "a patch with another's contacts";
        EXPECT_EQ(b.normals, i % 4 == 3 ? 3 : 0);
        EXPECT_EQ(b.row, int(5 * (i / 4) + i % 4));
      }
      // Felt through one of its rows, a patch comes before those that are not.
      if (most < 15) continue;
      for (const std::uint64_t patch : {20u, 70u, 110u})
        EXPECT_TRUE(std::any_of(small.blocks.begin(), small.blocks.end(), [&](const Block& b) {
          return b.id == patch;
        })) << patch;
      // Solved from nothing, the small problem gives the forces of the full one.
      SolveWorkspace ws;
      ws.lambda.assign(std::size_t(small.rows), 0.0);
      solve(small, small.delta_free, {5000, 1e-15}, ws);
      for (const Block& b : small.blocks)
        for (int k = 0; k < b.rows(); ++k) {
          const std::size_t row = std::size_t(5 * (b.id / 10) + b.id % 10) + std::size_t(k);
          EXPECT_NEAR(ws.lambda[std::size_t(b.row + k)], full.lambda[row], 1e-12);
        }
    }
}

}  // namespace
}  // namespace insula
