// SPDX-License-Identifier: GPL-3.0-or-later
// Problems of a whole exercise, condensed: the hands' forces after another step's displacement, compared with those of
// the full problems.
#include <gtest/gtest.h>

#include <algorithm>
#include <cstdio>

#include "core/haptics/condense.h"
#include "core/haptics/condense_for_test.h"
#include "core/sim/motion.h"
#include "core/testing/example.h"
#include "engine/live/headless.h"
#include "engine/live/live_engine.h"
#include "engine/live/publisher.h"

namespace insula {
namespace {

using testing::hand_wrenches, testing::Wrenches;
constexpr SolveSettings few_sweeps{.max_sweeps = 400, .tolerance_m = 1e-10, .conjugate = true, .max_newton = 20};
constexpr int every = 4, max_compared = 120;

TEST(CondenseExercise, AClippingIsFeltAsByTheWholeProblem) {
  const auto scene = std::filesystem::path(INSULA_SOURCE_DIR) / "scenes/training/3_clipping.xml";
  const auto loaded = load_simulation(scene, test::builtin(), 1);
  ASSERT_TRUE(loaded.simulation) << loaded.diagnostics.format();
  Simulation& simulation = *loaded.simulation;
  simulation.set_collision_horizon(Publisher::collision_horizon_steps * simulation.h());
  const Motion motion = load_motion(find_motion(simulation, "steady"));
  HeadlessRun run(simulation, motion);
  Condenser condense;
  ConstraintProblem small;
  int compared = 0, large = 0;
  double max_error_N = 0, max_change_N = 0;
  while (compared < max_compared && simulation.time() < motion.duration()) {
    run.step();
    const ConstraintProblem& full = simulation.problem();
    if (full.rows <= Publisher::max_rows || large++ % every != 0) continue;
    condense(full, Publisher::max_rows, small);
    Wrenches still{Vec6::Zero(), Vec6::Zero()}, on = still;
    for (std::size_t t = 0; t < full.tools.size(); ++t) {
      const int hand = full.tools[t].hand;
      on[t] = displacement(motion.at(hand, simulation.time()).pose,
                           motion.at(hand, simulation.time() + simulation.h()).pose);
    }
    const auto before = hand_wrenches(full, still, few_sweeps), whole = hand_wrenches(full, on, few_sweeps),
               cut = hand_wrenches(small, on, few_sweeps);
    for (std::size_t t = 0; t < 2; ++t) {
      max_error_N = std::max(max_error_N, (cut[t] - whole[t]).head<3>().norm());
      max_change_N = std::max(max_change_N, (whole[t] - before[t]).head<3>().norm());
    }
    ++compared;
  }
  std::printf("%d problems: off by %.4f mN at most, of a change of %.2f mN in a step\n", compared, 1e3 * max_error_N,
              1e3 * max_change_N);
  EXPECT_GT(compared, max_compared / 2);
  EXPECT_GT(max_change_N, 5e-3);
  EXPECT_LT(max_error_N, 2e-3 * max_change_N);
}

}  // namespace
}  // namespace insula
