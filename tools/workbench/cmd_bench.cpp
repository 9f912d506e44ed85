// SPDX-License-Identifier: GPL-3.0-or-later
// insula bench: where the time of a step goes.
#include <fmt/ostream.h>

#include <nlohmann/json.hpp>

#include "core/linalg/kernels.h"
#include "core/mechanics/deformable_body.h"
#include "engine/live/headless.h"
#include "engine/reports/report_writer.h"
#include "tools/workbench/workbench.h"

namespace insula {

namespace {

double factor_ms(const Simulation& simulation) {
  double sum = 0;
  for (const Body* b : simulation.bodies())
    if (const auto* deformable = dynamic_cast<const DeformableBody*>(b)) sum += deformable->factor_ms();
  return sum;
}

}  // namespace

int cmd_bench(const CommandContext& context, const BenchOptions& options) {
  const OpenedRun opened =
      open_run(context, options.scene, options.motion, options.motion == "steady", options.threads);
  if (!opened.simulation) return 2;
  Simulation& simulation = *opened.simulation;
  const Motion& motion = opened.motion;
  HeadlessRun run(simulation, motion);
  const auto warm_up = std::max<std::int64_t>(5, std::int64_t(options.from / simulation.h()));
  for (std::int64_t k = 0; k < warm_up; ++k) run.step();

  std::array<std::vector<double>, stage_count> stage;
  std::vector<double> step, haptic, rows, sweeps, newton, residual, iterations, age, defect, factor_and_w, all_else;
  for (int k = 0; k < options.steps; ++k) {
    run.step();
    const StepReport& r = simulation.report();
    for (int s = 0; s < stage_count; ++s) stage[std::size_t(s)].push_back(r.stage_ms[std::size_t(s)]);
    step.push_back(r.step_ms);
    haptic.push_back(run.haptic_ms());
    rows.push_back(r.rows);
    sweeps.push_back(r.solve.sweeps);
    newton.push_back(r.solve.newton_steps);
    factor_and_w.push_back(r.stage_ms[stage_build] + factor_ms(simulation));
    all_else.push_back(r.step_ms - factor_and_w.back());
    residual.push_back(r.solve.residual_m);
    iterations.push_back(r.solver.iterations);
    age.push_back(r.solver.age);
    defect.push_back(r.defect_m);
  }
  auto mean = [](const std::vector<double>& v) {
    double sum = 0;
    for (double x : v) sum += x;
    return v.empty() ? 0.0 : sum / double(v.size());
  };
  const double factor = simulation.h() * 1000 / std::max(1e-9, mean(step));
  if (options.json) {
    nlohmann::json j;
    j["scene"] = options.scene.string();
    j["kernels"] = kernels().name;
    j["threads"] = simulation.workers().threads();
    j["steps"] = options.steps;
    j["step_ms"] = {{"mean", mean(step)}, {"p50", percentile(step, 0.5)}, {"p95", percentile(step, 0.95)}};
    for (int s = 0; s < stage_count; ++s)
      j["stage_ms"][stage_names()[std::size_t(s)]] = {{"p50", percentile(stage[std::size_t(s)], 0.5)},
                                                      {"p95", percentile(stage[std::size_t(s)], 0.95)}};
    j["servo_ms_per_step"] = mean(haptic);
    j["rows"] = {{"mean", mean(rows)}, {"max", percentile(rows, 1.0)}};
    j["sweeps"] = {{"mean", mean(sweeps)}, {"max", percentile(sweeps, 1.0)}};
    j["newton_steps"] = {{"mean", mean(newton)}, {"max", percentile(newton, 1.0)}};
    j["factor_and_w_ms"] = {{"mean", mean(factor_and_w)}, {"p50", percentile(factor_and_w, 0.5)}};
    j["all_else_ms"] = {{"mean", mean(all_else)}, {"p50", percentile(all_else, 0.5)}};
    j["residual_m"] = {{"p50", percentile(residual, 0.5)}, {"max", percentile(residual, 1.0)}};
    j["iterations"] = {{"mean", mean(iterations)}, {"max", percentile(iterations, 1.0)}};
    j["factor_age"] = {{"mean", mean(age)}, {"max", percentile(age, 1.0)}};
    j["factors"] = simulation.report().solver.factors;
    j["defect_m"] = {{"p50", percentile(defect, 0.5)}, {"max", percentile(defect, 1.0)}};
    j["real_time_factor"] = factor;
    context.out << j.dump(2) << '\n';
    return 0;
  }
  fmt::print(context.out, "{}  ({} kernels, {} threads, {} steps of {:.2f} ms)\n", options.scene.string(),
             kernels().name, simulation.workers().threads(), options.steps, simulation.h() * 1000);
  for (const Body* b : simulation.bodies())
    if (const auto* soft = dynamic_cast<const DeformableBody*>(b))
      fmt::print(context.out, "  {:<12} {} nodes, factor of {} numbers and {:.1f} Mflop\n", soft->id, soft->nodes(),
                 soft->solver_cost().factor_entries, soft->solver_cost().factor_flops * 1e-6);
  fmt::print(context.out, "\n  {:<14}{:>9}{:>9}\n", "stage, ms", "p50", "p95");
  for (int s = 0; s < stage_count; ++s)
    fmt::print(context.out, "  {:<14}{:>9.3f}{:>9.3f}\n", stage_names()[std::size_t(s)],
               percentile(stage[std::size_t(s)], 0.5), percentile(stage[std::size_t(s)], 0.95));
  fmt::print(context.out, "  {:<14}{:>9.3f}{:>9.3f}\n\n", "step", percentile(step, 0.5), percentile(step, 0.95));
  // With more threads factors are made side by side, and their sum says nothing about the step.
  if (simulation.workers().threads() == 1)
    fmt::print(context.out, "  factor and W (build) {:.3f} ms, all else {:.3f}; means {:.3f} and {:.3f}\n",
               percentile(factor_and_w, 0.5), percentile(all_else, 0.5), mean(factor_and_w), mean(all_else));
  fmt::print(context.out,
             "  rows {:.0f} mean, {:.0f} max; sweeps {:.1f} mean, Newton steps {:.1f}; residual {:.1e} m at most\n",
             mean(rows), percentile(rows, 1.0), mean(sweeps), mean(newton), percentile(residual, 1.0));
  if (mean(iterations) > 0)
    fmt::print(context.out,
               "  conjugate gradients: {:.1f} iterations mean, {:.0f} max; factor {:.1f} steps old, {:.0f} at most, {} "
               "in all; last defect {:.1e} m at most\n",
               mean(iterations), percentile(iterations, 1.0), mean(age), percentile(age, 1.0),
               simulation.report().solver.factors, percentile(defect, 1.0));
  fmt::print(context.out, "  servo of both hands: {:.3f} ms a step; real_time_factor of the engine alone {:.2f}\n",
             mean(haptic), factor);
  return 0;
}

}  // namespace insula
