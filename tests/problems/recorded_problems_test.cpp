// SPDX-License-Identifier: GPL-3.0-or-later
// Problems recorded from the four exercises: each method comes to the tolerance, and all to the same motion.
#include <gtest/gtest.h>

#include <algorithm>
#include <cstdio>

#include "core/constraint/problem_file.h"
#include "tests/physics/random_problem.h"

namespace insula {
namespace {

constexpr double solved_to = 1e-8;  // m

struct Solved {
  SolveStats stats;
  std::vector<double> lambda, delta;
};

Solved solved(const ConstraintProblem& p, const SolveSettings& settings) {
  SolveWorkspace ws;
  ws.reserve(p.rows);
  ws.lambda = p.lambda;
  const SolveStats stats = solve(p, p.delta_free, settings, ws);
  return {stats, ws.lambda, ws.delta};
}

double largest_difference(const std::vector<double>& a, const std::vector<double>& b) {
  double most = 0;
  for (std::size_t i = 0; i < a.size(); ++i) most = std::max(most, std::abs(a[i] - b[i]));
  return most;
}

/// Share `q` of the values lie below.
int quantile(std::vector<int> v, double q) {
  std::sort(v.begin(), v.end());
  return v[std::min(v.size() - 1, std::size_t(q * double(v.size())))];
}

/// Which problems are recorded depends on the processor's bits, and one in hundreds may be out of a method's reach.
int allowed(std::size_t files) { return int(files / 100); }

TEST(RecordedProblems, EachMethodSolvesThem) {
  const auto files = problem_files(INSULA_PROBLEM_FOLDER);
  ASSERT_GE(files.size(), 200u);
  const struct {
    const char* name;
    SolveSettings settings;
  } methods[] = {{"sweeps, Newton", {150, solved_to, false, 20}},
                 {"conjugate, Newton", {150, solved_to, true, 20}},
                 {"Newton at once", {1, solved_to, false, 20}}};
  for (const auto& m : methods) {
    std::vector<int> sweeps, newton;
    double worst_N = 0;
    int unsolved = 0, at_the_cap = 0;
    for (const auto& file : files) {
      const ConstraintProblem p = read_problem(file);
      const Solved s = solved(p, m.settings);
      unsolved += !(s.stats.residual_m <= solved_to);
      at_the_cap += s.stats.newton_steps >= m.settings.max_newton;
      EXPECT_LE(s.stats.residual_m, 100 * solved_to) << m.name << ": " << file.filename();
      EXPECT_LE(s.stats.sweeps, 2 * 150 + 20 * (9 + 32)) << m.name << ": " << file.filename();
      test::expect_bounds(p, s.lambda);
      worst_N = std::max(worst_N, s.stats.residual_N);
      sweeps.push_back(s.stats.sweeps);
      newton.push_back(s.stats.newton_steps);
    }
    EXPECT_LE(unsolved, allowed(files.size())) << m.name;
    EXPECT_LE(at_the_cap, allowed(files.size())) << m.name;
    std::printf("%-18s sweeps %d %d %d, Newton steps %d %d %d (p50, p95, most), residual %.1e N at most\n", m.name,
                quantile(sweeps, 0.5), quantile(sweeps, 0.95), quantile(sweeps, 1), quantile(newton, 0.5),
                quantile(newton, 0.95), quantile(newton, 1), worst_N);
  }
}

// lambda need not be unique (redundant contacts, friction), so W lambda + delta_free is compared: where things go.
TEST(RecordedProblems, MethodsAgreeOnTheMotion) {
  std::vector<double> differences;
  const auto files = problem_files(INSULA_PROBLEM_FOLDER);
  int unsolved = 0;
  for (const auto& file : files) {
    const ConstraintProblem p = read_problem(file);
    const Solved plain = solved(p, {20000, 1e-11, false, 0}), newton = solved(p, {1, 1e-11, false, 40});
    if (!(std::max(plain.stats.residual_m, newton.stats.residual_m) <= 1e-9)) {
      ++unsolved;
      continue;
    }
    differences.push_back(largest_difference(plain.delta, newton.delta));
  }
  EXPECT_LE(unsolved, allowed(files.size()));
  std::sort(differences.begin(), differences.end());
  std::printf("difference of delta: %.1e m median, %.1e m at most\n", differences[differences.size() / 2],
              differences.back());
  EXPECT_LT(differences[differences.size() / 2], 1e-9);
  EXPECT_LT(differences.back(), 1e-6);
}

}  // namespace
}  // namespace insula
