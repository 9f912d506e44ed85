// SPDX-License-Identifier: GPL-3.0-or-later
// Problems of a whole exercise, cut down: what a hand feels of them, a step's way on, against the whole ones.
#include <gtest/gtest.h>

#include <algorithm>
#include <cstdio>

#include "core/sim/motion.h"
#include "core/testing/example.h"
#include "engine/condense.h"
#include "engine/condense_for_test.h"
#include "engine/headless.h"
#include "engine/live_engine.h"
#include "engine/publisher.h"

namespace insula {
namespace {

using testing::felt, testing::Wrenches;
constexpr SolveSettings well{.max_sweeps = 400, .tolerance_m = 1e-10, .conjugate = true, .max_newton = 20};
constexpr int every = 4, most_compared = 120;

TEST(CondenseExercise, AClippingIsFeltAsByTheWholeProblem) {
  const auto scene = std::filesystem::path(INSULA_SOURCE_DIR) / "scenes/training/3_clipping.xml";
  const auto loaded = load_simulation(scene, test::builtin(), 1);
  ASSERT_TRUE(loaded.simulation) << loaded.diagnostics.format();
  Simulation& simulation = *loaded.simulation;
  simulation.look_ahead(Publisher::look_ahead_steps * simulation.h());
  const Motion motion = load_motion(find_motion(simulation, "steady"));
  HeadlessRun run(simulation, motion);
  Condenser condense;
  ConstraintProblem small;
  int compared = 0, large = 0;
  double most_off_N = 0, most_change_N = 0;
  while (compared < most_compared && simulation.time() < motion.duration()) {
    run.step();
    const ConstraintProblem& full = simulation.problem();
    if (full.rows <= Publisher::most_rows || large++ % every != 0) continue;
    condense(full, Publisher::most_rows, small);
    Wrenches still{Vec6::Zero(), Vec6::Zero()}, on = still;
    for (std::size_t t = 0; t < full.tools.size(); ++t) {
      const int hand = full.tools[t].hand;
      on[t] = displacement(motion.at(hand, simulation.time()).pose, motion.at(hand, simulation.time() + simulation.h()).pose);
    }
    const auto before = felt(full, still, well), whole = felt(full, on, well), cut = felt(small, on, well);
    for (std::size_t t = 0; t < 2; ++t) {
      most_off_N = std::max(most_off_N, (cut[t] - whole[t]).head<3>().norm());
      most_change_N = std::max(most_change_N, (whole[t] - before[t]).head<3>().norm());
    }
    ++compared;
  }
  std::printf("%d problems: off by %.4f mN at most, of a change of %.2f mN in a step\n", compared, 1e3 * most_off_N, 1e3 * most_change_N);
  EXPECT_GT(compared, most_compared / 2);
  EXPECT_GT(most_change_N, 5e-3);
  EXPECT_LT(most_off_N, 2e-3 * most_change_N);
}

}  // namespace
}  // namespace insula
