// SPDX-License-Identifier: GPL-3.0-or-later
// What allocates: nothing in solve, nothing in a step once it has seen its largest problem. Every operator new of this
// program counts.
#include <gtest/gtest.h>

#include "core/testing/example.h"
#include "core/testing/count_allocations.h"

namespace insula {
namespace {

const std::filesystem::path plugins = std::filesystem::path(INSULA_SOURCE_DIR) / "plugins";

TEST(Allocation, TheCounterCounts) {
  const long before = allocations;
  { std::vector<double> v(10); }
  EXPECT_GT(allocations - before, 0);
}

TEST(Allocation, SolveAllocatesNothing) {
  auto s = test::load(plugins / "strand_springs" / "example.xml");
  ASSERT_TRUE(s);
  test::run_script(*s, 30);
  const ConstraintProblem p = s->problem();
  ASSERT_GT(p.rows, 5);
  SolveWorkspace ws;
  ws.reserve(p.rows);
  ws.lambda.assign(std::size_t(p.rows), 0.0);
  solve(p, p.delta_free, {1, 1e-9}, ws);  // the first call picks the processor's kernels
  ws.lambda.assign(std::size_t(p.rows), 0.0);
  SolveWorkspace fresh;
  fresh.reserve(p.rows);
  fresh.lambda.assign(std::size_t(p.rows), 0.0);
  const long before = allocations;
  solve(p, p.delta_free, {200, 1e-9}, ws);
  solve(p, p.delta_free, {200, 1e-9}, fresh);
  EXPECT_EQ(allocations - before, 0);
}

// The script once to see the largest problem, then again from the start: no step may allocate, but for the events it
// reports and the contacts that a test of its own watches.
TEST(Allocation, AWarmStepAllocatesNothing) {
  for (const char* plugin : {"corotational_fem", "strand_springs", "dissector", "suction", "retractor", "fixed"}) {
    auto s = test::load(plugins / plugin / "example.xml", 2);
    ASSERT_TRUE(s);
    test::run_script(*s, 70);
    s->reset();
    long worst = 0;
    int worst_step = 0;
    for (int i = 0; i < 70; ++i) {
      test::drive(*s);
      const long before = allocations;
      s->step();
      const long count = allocations - before;
      if (s->events().empty() && count > worst) {
        worst = count;
        worst_step = i;
      }
    }
    EXPECT_EQ(worst, 0) << plugin << " at step " << worst_step;
  }
}

}  // namespace
}  // namespace insula
