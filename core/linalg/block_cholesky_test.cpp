// SPDX-License-Identifier: GPL-3.0-or-later
// The direct solver of the processor in double and single precision.
#include "core/linalg/block_cholesky.h"
#include "core/linalg/body_solver_for_test.h"
#include "core/linalg/direct_solver.h"

namespace insula::test {
namespace {

template <class Real>
struct OnProcessor {
  static constexpr bool is_double = sizeof(Real) == 8, keeps_single_rows = true;
  static constexpr double tolerance = is_double ? 1e-13 : 2e-5, epsilon = double(std::numeric_limits<Real>::epsilon());
  static std::unique_ptr<BodySolver> make() { return std::make_unique<MultifrontalCholesky<Real>>(); }
};
using Precisions = testing::Types<OnProcessor<double>, OnProcessor<float>>;
INSTANTIATE_TYPED_TEST_SUITE_P(Processor, BodySolverContract, Precisions);

// The lesser precision costs what its rounding says, not more: W in float against W in double.
TEST(DirectSolver, SinglePrecisionIsAsGoodAsItsRounding) {
  SolverProblem p = make_problem(8, 8, 6, 60, 3);
  std::vector<double> w[2];
  for (int single = 0; single < 2; ++single) {
    const auto solver = make_direct_solver(single);
    solver->analyse(p.a);
    ASSERT_TRUE(solver->factorise(p.a));
    w[single].assign(60 * 64, 0.0);
    solver->compute_compliance(p.rows, p.identity);
    solver->add_compliance(p.rows, w[single].data(), 64);
  }
  double largest = 0, error = 0;
  for (std::size_t i = 0; i < w[0].size(); ++i) {
    largest = std::max(largest, std::abs(w[0][i]));
    error = std::max(error, std::abs(w[0][i] - w[1][i]));
  }
  EXPECT_LT(error, 2e-6 * largest);
  EXPECT_GT(error, 1e-9 * largest);
}

}  // namespace
}  // namespace insula::test
