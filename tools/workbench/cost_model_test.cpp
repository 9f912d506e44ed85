// SPDX-License-Identifier: GPL-3.0-or-later
// The cost model's counts against the real ones, and what it makes of them. No times: those are the machine's.
#include "tools/workbench/cost_model.h"
#include "core/sim/channel_sum.h"

#include <gtest/gtest.h>

#include "core/linalg/direct_solver.h"
#include "core/mechanics/soft_body.h"
#include "core/testing/example.h"
#include "engine/live/headless.h"
#include "tools/workbench/scaling_scene.h"
#include "tools/workbench/workbench.h"

namespace insula {
namespace {

const std::filesystem::path scenes = std::filesystem::path(INSULA_SOURCE_DIR) / "scenes";

TEST(CostModel, CountsAreTheRealOnes) {
  const auto s = brick_scene({6, 4, 3, 0}, test::builtin(), 1);
  s->step();
  const SceneWork w = count_work(*s);
  ASSERT_EQ(w.bodies.size(), 2u);
  EXPECT_EQ(w.bodies[0].elements, 6 * 6 * 6 * 6);
  EXPECT_EQ(w.bodies[1].nodes, 5 * 5 * 5);
  EXPECT_EQ(w.surface_vertices, (343 - 125) + (125 - 27));
  EXPECT_EQ(w.standing_rows, int(channel_sum(*s, "standing")));
  EXPECT_EQ(w.expected_rows, w.standing_rows);
  std::size_t i = 0;
  for (const char* name : {"lower", "upper"}) {
    const auto* body = s->scene().find_as<SoftBody>(name);
    const auto anew = make_direct_solver(false);
    anew->analyse(body->system());
    EXPECT_EQ(w.bodies[i].solver.factor_flops, anew->cost().factor_flops);
    EXPECT_EQ(w.bodies[i].solver.factor_entries, anew->cost().factor_entries);
    EXPECT_EQ(w.bodies[i].rows, body->rows.count());
    ++i;
  }
}

TEST(CostModel, RowsOfAnExerciseLieInTheRange) {
  std::ostringstream out, err;
  const CommandContext context{test::builtin(), out, err};
  const OpenedRun opened = open_run(context, scenes / "training/1_sylvian_fissure.xml", "steady", false, 1);
  ASSERT_TRUE(opened.simulation) << err.str();
  HeadlessRun run(*opened.simulation, opened.motion);
  run.step();
  const SceneWork w = count_work(*opened.simulation);
  int most = 0;
  for (int k = 0; k < 600; ++k) {
    run.step();
    most = std::max(most, opened.simulation->report().rows);
  }
  EXPECT_LE(most, w.max_rows);
  EXPECT_GT(most, 0.6 * w.expected_rows);
  EXPECT_LT(most, 1.6 * w.expected_rows);
}

CostRates flat() {
  CostRates r;
  r.tetrahedron = 4e-8, r.tetrahedron_force = 2e-8, r.factor_flop = 2e-11, r.factor_entry = 1e-9, r.solve_entry = 1e-9;
  r.compliance_flop = 2e-11, r.compliance_row2 = 2e-9, r.vertex = 4e-8, r.sweep_row2 = 2e-10;
  return r;
}

TEST(CostModel, TellsWhatTakesMostAndWhatToDo) {
  SceneWork w;
  w.h = 1.0 / 60;
  w.bodies.push_back({"lobe", 20000, 100000, false, false, false, w.h, 60, {30000000, 3e10, 5e8, 0}, 1e9});
  const CostEstimate slow = estimate(w, flat(), 1);
  EXPECT_GT(slow.step_ms, 600);  // the factor alone
  EXPECT_NE(slow.most.find("the factor of \"lobe\""), std::string::npos) << slow.most;
  ASSERT_FALSE(slow.advice.empty());
  EXPECT_NE(slow.advice.front().find("fewer nodes in \"lobe\""), std::string::npos);
  EXPECT_NE(slow.advice.front().find("asynchronous"), std::string::npos);
  // Made beside the steps, the same factor costs some solves.
  w.bodies[0].background = true;
  EXPECT_LT(estimate(w, flat(), 1).step_ms, 0.2 * slow.step_ms);
  w.bodies[0] = {"lobe", 500, 2000, false, false, false, w.h, 60, {100000, 1e7, 1.6e6, 0}, 1e7};
  const CostEstimate quick = estimate(w, flat(), 1);
  EXPECT_LT(quick.step_ms, 1000 * w.h);
  EXPECT_TRUE(quick.advice.empty());
  // Two of them on two threads take as long as one; on one thread twice as long.
  w.bodies.push_back(w.bodies[0]);
  EXPECT_DOUBLE_EQ(estimate(w, flat(), 2).stage_ms[stage_free_motion], quick.stage_ms[stage_free_motion]);
  EXPECT_NEAR(estimate(w, flat(), 1).stage_ms[stage_free_motion], 2 * quick.stage_ms[stage_free_motion], 1e-12);
  // A kept factor costs little but now and then.
  w.bodies.pop_back();
  w.bodies[0].keeps_tangent = true;
  EXPECT_LT(estimate(w, flat(), 1).stage_ms[stage_free_motion], quick.stage_ms[stage_free_motion]);
  EXPECT_GT(estimate(w, flat(), 1).refactor_ms, 0);
}

TEST(CostModel, RatesArePositive) {
  const CostRates r = measure_rates(test::builtin());
  for (double rate : {r.tetrahedron, r.tetrahedron_force, r.factor_flop, r.solve_entry, r.compliance_flop,
                      r.compliance_row2, r.vertex, r.sweep_row2})
    EXPECT_GT(rate, 0);
  // Rates of dense products, whatever the machine, are of one order: none may be that of work that was skipped.
  EXPECT_GT(r.compliance_flop, 0.05 * r.factor_flop);
  EXPECT_LT(r.compliance_flop, 50 * r.factor_flop);
}

}  // namespace
}  // namespace insula
