// SPDX-License-Identifier: GPL-3.0-or-later
// The solver on an OpenCL device: the contract of all solvers, closed forms, patterns of every kind against the
// processor, and a device that fails. Skipped where there is no device.
#include "core/linalg/body_solver_for_test.h"
#include "core/linalg/direct_solver.h"
#include "core/linalg/opencl/guarded_solver.h"
#include "core/linalg/opencl_solver.h"

namespace insula::test {
namespace {

using opencl::GuardedSolver;
using opencl::OpenclCholesky;

/// Unguarded: a device that fails fails the test. Null without a device.
std::unique_ptr<OpenclCholesky> on_device() {
  const auto devices = opencl::find_devices();
  return devices.empty() ? nullptr : std::make_unique<OpenclCholesky>(devices.front());
}

struct OnDevice {
  static constexpr bool is_double = true, keeps_single_rows = false;
  static constexpr double tolerance = 1e-13, epsilon = std::numeric_limits<double>::epsilon();
  static std::unique_ptr<BodySolver> make() { return on_device(); }
};
INSTANTIATE_TYPED_TEST_SUITE_P(Opencl, BodySolverContract, OnDevice);

class OpenclSolver : public testing::Test {
 protected:
  void SetUp() override {
    device = on_device();
    if (!device) GTEST_SKIP() << "there is no OpenCL device";
  }
  std::unique_ptr<OpenclCholesky> device;
};

/// Identity, and -1 for each third node: as if it were fixed.
std::vector<int> some_fixed(int nodes) {
  std::vector<int> out(static_cast<std::size_t>(nodes));
  for (int i = 0; i < nodes; ++i) out[std::size_t(i)] = i % 3 == 2 ? -1 : i;
  return out;
}

/// Rows at nodes spread over the body; every fifth one is empty.
BodyRows spread_rows(int nodes, int m) {
  BodyRows rows;
  rows.clear();
  for (int r = 0; r < m; ++r) {
    rows.open(r);
    for (int k = 0; r % 5 != 4 && k < 1 + r % 4; ++k)
      rows.add(int((long(r) * nodes / m + 7L * k) % nodes), Vec3(1 + 0.1 * k, -0.3 * k, 0.5));
  }
  return rows;
}

/// A matrix with these couplings, numbers of the size of one, diagonally dominant.
BlockMatrix filled(int nodes, const std::vector<std::pair<int, int>>& couplings) {
  BlockMatrix a;
  a.set_pattern(nodes, couplings);
  std::mt19937 random(7);
  std::uniform_real_distribution<double> u(-1, 1);
  std::vector<double> sum(std::size_t(nodes), 1.0);
  for (int j = 0; j < nodes; ++j)
    for (int s = a.column_start(j); s < a.column_start(j + 1); ++s) {
      if (a.row(s) == j) continue;
      for (int k = 0; k < 9; ++k) a.block(s)[k] = u(random);
      sum[std::size_t(a.row(s))] += 3;
      sum[std::size_t(j)] += 3;
    }
  for (int j = 0; j < nodes; ++j)
    for (int k = 0; k < 3; ++k) a.block(a.diagonal(j))[4 * k] = sum[std::size_t(j)];
  return a;
}

/// Everything a step asks of a solver, in one list of numbers.
std::vector<double> step_of(BodySolver& solver, const BlockMatrix& a, const BodyRows& rows,
                            const std::vector<int>& node) {
  const int m = rows.count();
  const VecX load = VecX::LinSpaced(3 * a.nodes(), -1, 2), lambda = VecX::LinSpaced(std::max(m, 1), 1, 2);
  std::vector<double> out(std::size_t(m * m + m), 0.0);
  EXPECT_TRUE(solver.begin_motion(&a, load, load));
  solver.compute_compliance(rows, node);
  solver.add_compliance(rows, out.data(), m);
  solver.add_free_motion(rows, out.data() + m * m);
  VecX x;
  for (const bool free : {true, false}) {
    if (free) solver.unforced_motion(load, x);
    else solver.end_motion(rows, lambda.data(), x);
    out.insert(out.end(), x.data(), x.data() + x.size());
  }
  x = load;
  solver.solve(x.data());
  out.insert(out.end(), x.data(), x.data() + x.size());
  return out;
}

double largest_difference(const std::vector<double>& a, const std::vector<double>& b) {
  EXPECT_EQ(a.size(), b.size());
  double most = 0, size = 0;
  for (std::size_t i = 0; i < a.size(); ++i) {
    most = std::isfinite(a[i]) ? std::max(most, std::abs(a[i] - b[i])) : INFINITY;
    size = std::max(size, std::abs(b[i]));
  }
  return most / size;
}

std::vector<std::pair<int, int>> box(int side) {
  std::vector<std::pair<int, int>> out;
  const int step[3] = {1, side, side * side};
  for (int i = 0; i < side * side * side; ++i)
    for (int d = 0; d < 3; ++d)
      if (i / step[d] % side + 1 < side) out.emplace_back(i, i + step[d]);
  return out;
}

// Patterns at the ends of what can happen: nothing coupled, everything coupled (one supernode of several tiles), a
// chain (a tall tree), a star (one parent with many children), two bodies in one matrix, and a box.
TEST_F(OpenclSolver, AgreesWithTheProcessorOnEveryPattern) {
  std::vector<std::pair<int, int>> all, chain, star, two;
  for (int i = 0; i < 55; ++i)
    for (int j = 0; j < i; ++j) all.emplace_back(i, j);
  for (int i = 1; i < 300; ++i) chain.emplace_back(i - 1, i);
  for (int i = 1; i < 150; ++i) star.emplace_back(0, i);
  for (int i = 1; i < 60; ++i)
    if (i != 30) two.emplace_back(i - 1, i);
  const std::vector<std::tuple<const char*, int, std::vector<std::pair<int, int>>>> patterns = {
      {"one node", 1, {}}, {"nothing coupled", 40, {}}, {"one supernode", 55, all}, {"chain", 300, chain},
      {"star", 150, star}, {"two bodies", 60, two},     {"box", 729, box(9)}};
  for (const auto& [name, nodes, couplings] : patterns) {
    const BlockMatrix a = filled(nodes, couplings);
    const auto processor = make_direct_solver(false);
    processor->analyse(a);
    device->analyse(a);
    for (int m : {45, 0, 7}) {
      const BodyRows rows = spread_rows(nodes, m);
      const std::vector<int> node = some_fixed(nodes);
      const auto there = step_of(*device, a, rows, node), here = step_of(*processor, a, rows, node);
      EXPECT_TRUE(held("a step on a device = on the processor", largest_difference(there, here), 1, 1e-12))
          << name << ", " << m << " rows";
    }
  }
}

// A chain of n equal springs and n - 1 nodes between two walls: the force one at node i moves node j by
// min(i, j) (n - max(i, j)) / (n k).
TEST_F(OpenclSolver, MovesAChainBetweenWallsAsTheClosedFormSays) {
  const int nodes = 149, n = nodes + 1;
  const double k = 2;
  std::vector<std::pair<int, int>> pairs;
  for (int i = 1; i < nodes; ++i) pairs.emplace_back(i - 1, i);
  BlockMatrix a;
  a.set_pattern(nodes, pairs);
  for (int i = 0; i < nodes; ++i)
    for (int d = 0; d < 3; ++d) {
      a.block(a.diagonal(i))[4 * d] = 2 * k;
      if (i > 0) a.block(a.slot(i, i - 1))[4 * d] = -k;
    }
  device->analyse(a);
  ASSERT_TRUE(device->factorise(a));
  BodyRows rows;
  rows.clear();
  std::vector<int> node(nodes);
  const int m = 40;
  for (int i = 0; i < nodes; ++i) node[std::size_t(i)] = i;
  for (int r = 0; r < m; ++r) {
    rows.open(r);
    rows.add(3 * r, Vec3(0, 1, 0));
  }
  device->compute_compliance(rows, node);
  std::vector<double> w(m * m, 0.0);
  device->add_compliance(rows, w.data(), m);
  for (int r = 0; r < m; ++r)
    for (int c = 0; c < m; ++c) {
      const double i = 3 * std::min(r, c) + 1, j = 3 * std::max(r, c) + 1;
      EXPECT_TRUE(
          held("W of a chain on a device", std::abs(w[std::size_t(r * m + c)] - i * (n - j) / (n * k)), n / k, 1e-13));
    }
}

// Rows that come again with the same factor are not computed again, and after the first step nothing is allocated.
TEST_F(OpenclSolver, AllocatesNothingInAStep) {
  const BlockMatrix a = filled(729, box(9));
  std::vector<int> node(729);
  for (int i = 0; i < 729; ++i) node[std::size_t(i)] = i;
  device->analyse(a);
  const auto first = step_of(*device, a, spread_rows(729, 60), node);
  const int buffers = device->device().buffers_made();
  for (int m : {60, 33, 5, 60}) step_of(*device, a, spread_rows(729, m), node);
  EXPECT_EQ(device->device().buffers_made(), buffers);
  EXPECT_EQ(step_of(*device, a, spread_rows(729, 60), node), first);
}

// The second set of rows does not disturb the first.
TEST_F(OpenclSolver, KeepsTwoSetsOfRows) {
  const BlockMatrix a = filled(125, box(5));
  const std::vector<int> node = some_fixed(125);
  const BodyRows rows = spread_rows(125, 20), others = spread_rows(125, 50);
  device->analyse(a);
  ASSERT_TRUE(device->factorise(a));
  std::vector<double> first(400, 0.0), again(first), second(2500, 0.0), expected(second);
  device->compute_compliance(rows, node);
  device->add_compliance(rows, first.data(), 20);
  device->exchange_rows();
  device->compute_compliance(others, node);
  device->add_compliance(others, second.data(), 50);
  device->exchange_rows();
  device->add_compliance(rows, again.data(), 20);
  EXPECT_EQ(first, again);
  device->compute_compliance(others, node);
  device->add_compliance(others, expected.data(), 50);
  EXPECT_EQ(second, expected);
}

// Whatever call fails, the step's numbers are right, and so are those of the next step.
TEST_F(OpenclSolver, ADeviceThatFailsIsReplacedByTheProcessor) {
  const BlockMatrix a = filled(125, box(5)), other = filled(125, box(5));
  const std::vector<int> node = some_fixed(125);
  const BodyRows rows = spread_rows(125, 20);
  const auto processor = make_direct_solver(false);
  processor->analyse(a);
  const auto expected = step_of(*processor, a, rows, node);
  const opencl::FoundDevice found = opencl::find_devices().front();
  int lost = 0, kept = 0;
  for (int calls = 0; kept == 0 && calls < 10000; calls += 9) {
    GuardedSolver solver(found);
    solver.analyse(a);
    solver.device()->fail_after(calls);
    EXPECT_LT(largest_difference(step_of(solver, a, rows, node), expected), 1e-12) << calls;
    (solver.device_lost() ? lost : kept) += 1;
    EXPECT_LT(largest_difference(step_of(solver, other, rows, node), expected), 1e-12) << calls;
    EXPECT_EQ(solver.device_name(), found.name);
  }
  EXPECT_GT(lost, 3);
  EXPECT_EQ(kept, 1);
}

// A body that asks for the faster solver gets what the trial finds.
TEST_F(OpenclSolver, IsChosenOnlyWhereItSavesAFifth) {
  EXPECT_FALSE((SolverTrial{1, 0.81}.device_is_faster()));
  EXPECT_TRUE((SolverTrial{1, 0.79}.device_is_faster()));
  EXPECT_FALSE(SolverTrial{}.device_is_faster());
  const SolverTrial trial = try_solvers(filled(125, box(5)));
  EXPECT_GT(trial.processor_s, 0);
  EXPECT_GT(trial.device_s, 0);
}

}  // namespace
}  // namespace insula::test
