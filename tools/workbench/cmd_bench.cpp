// SPDX-License-Identifier: GPL-3.0-or-later
// insula bench: where the time of a step goes.
#include <fmt/ostream.h>

#include <nlohmann/json.hpp>

#include "core/linalg/kernels.h"
#include "core/mechanics/deformable_body.h"
#include "engine/reports/report_writer.h"
#include "tools/workbench/measured_run.h"
#include "tools/workbench/workbench.h"

namespace insula {

namespace {

double factor_ms(const Simulation& simulation) {
  double sum = 0;
  for (const Body* b : simulation.bodies())
    if (const auto* deformable = dynamic_cast<const DeformableBody*>(b)) sum += deformable->factor_ms();
  return sum;
}

/// Times and figures of the steps of a run, one value for each step.
struct BenchRecord {
  std::array<std::vector<double>, stage_count> stage;
  std::vector<double> step, haptic, rows, sweeps, newton, residual, iterations, age, defect, factor_and_w, all_else;

  void add(const Simulation& simulation, double haptic_ms) {
    const StepReport& r = simulation.report();
    for (int s = 0; s < stage_count; ++s) stage[std::size_t(s)].push_back(r.stage_ms[std::size_t(s)]);
    step.push_back(r.step_ms);
    haptic.push_back(haptic_ms);
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
  double real_time_factor(double h) const { return h * 1000 / std::max(1e-9, mean(step)); }
};

nlohmann::json as_json(const BenchRecord& r, Simulation& simulation, const BenchOptions& options) {
  const auto mean_and_max = [](const std::vector<double>& v) {
    return nlohmann::json{{"mean", mean(v)}, {"max", percentile(v, 1.0)}};
  };
  const auto mean_and_median = [](const std::vector<double>& v) {
    return nlohmann::json{{"mean", mean(v)}, {"p50", percentile(v, 0.5)}};
  };
  const auto median_and_max = [](const std::vector<double>& v) {
    return nlohmann::json{{"p50", percentile(v, 0.5)}, {"max", percentile(v, 1.0)}};
  };
  nlohmann::json j;
  j["scene"] = options.scene.string();
  j["kernels"] = kernels().name;
  j["threads"] = simulation.workers().threads();
  j["steps"] = options.steps;
  j["step_ms"] = {{"mean", mean(r.step)}, {"p50", percentile(r.step, 0.5)}, {"p95", percentile(r.step, 0.95)}};
  for (int s = 0; s < stage_count; ++s)
    j["stage_ms"][stage_names()[std::size_t(s)]] = {{"p50", percentile(r.stage[std::size_t(s)], 0.5)},
                                                    {"p95", percentile(r.stage[std::size_t(s)], 0.95)}};
  j["servo_ms_per_step"] = mean(r.haptic);
  j["rows"] = mean_and_max(r.rows);
  j["sweeps"] = mean_and_max(r.sweeps);
  j["newton_steps"] = mean_and_max(r.newton);
  j["factor_and_w_ms"] = mean_and_median(r.factor_and_w);
  j["all_else_ms"] = mean_and_median(r.all_else);
  j["residual_m"] = median_and_max(r.residual);
  j["iterations"] = mean_and_max(r.iterations);
  j["factor_age"] = mean_and_max(r.age);
  j["factors"] = simulation.report().solver.factors;
  j["defect_m"] = median_and_max(r.defect);
  j["real_time_factor"] = r.real_time_factor(simulation.h());
  return j;
}

void print_table(std::ostream& out, const BenchRecord& r, Simulation& simulation, const BenchOptions& options) {
  fmt::print(out, "{}  ({} kernels, {} threads, {} steps of {:.2f} ms)\n", options.scene.string(), kernels().name,
             simulation.workers().threads(), options.steps, simulation.h() * 1000);
  for (const Body* b : simulation.bodies())
    if (const auto* soft = dynamic_cast<const DeformableBody*>(b))
      fmt::print(out, "  {:<12} {} nodes, factor of {} numbers and {:.1f} Mflop\n", soft->id, soft->nodes(),
                 soft->solver_cost().factor_entries, soft->solver_cost().factor_flops * 1e-6);
  fmt::print(out, "\n  {:<14}{:>9}{:>9}\n", "stage, ms", "p50", "p95");
  for (int s = 0; s < stage_count; ++s)
    fmt::print(out, "  {:<14}{:>9.3f}{:>9.3f}\n", stage_names()[std::size_t(s)],
               percentile(r.stage[std::size_t(s)], 0.5), percentile(r.stage[std::size_t(s)], 0.95));
  fmt::print(out, "  {:<14}{:>9.3f}{:>9.3f}\n\n", "step", percentile(r.step, 0.5), percentile(r.step, 0.95));
  // With more threads factors are made side by side, and their sum says nothing about the step.
  if (simulation.workers().threads() == 1)
    fmt::print(out, "  factor and W (build) {:.3f} ms, all else {:.3f}; means {:.3f} and {:.3f}\n",
               percentile(r.factor_and_w, 0.5), percentile(r.all_else, 0.5), mean(r.factor_and_w), mean(r.all_else));
  fmt::print(out,
             "  rows {:.0f} mean, {:.0f} max; sweeps {:.1f} mean, Newton steps {:.1f}; residual {:.1e} m at most\n",
             mean(r.rows), percentile(r.rows, 1.0), mean(r.sweeps), mean(r.newton), percentile(r.residual, 1.0));
  if (mean(r.iterations) > 0)
    fmt::print(out,
               "  conjugate gradients: {:.1f} iterations mean, {:.0f} max; factor {:.1f} steps old, {:.0f} at most, {} "
               "in all; last defect {:.1e} m at most\n",
               mean(r.iterations), percentile(r.iterations, 1.0), mean(r.age), percentile(r.age, 1.0),
               simulation.report().solver.factors, percentile(r.defect, 1.0));
  fmt::print(out, "  servo of both hands: {:.3f} ms a step; real_time_factor of the engine alone {:.2f}\n",
             mean(r.haptic), r.real_time_factor(simulation.h()));
}

}  // namespace

int cmd_bench(const CommandContext& context, const BenchOptions& options) {
  const OpenedRun opened = open_for_measuring(context, options);
  if (!opened.simulation) return 2;
  Simulation& simulation = *opened.simulation;
  HeadlessRun run(simulation, opened.motion);
  warm_up(run, options, simulation.h());
  BenchRecord record;
  for (int k = 0; k < options.steps; ++k) {
    run.step();
    record.add(simulation, run.haptic_ms());
  }
  if (options.json) context.out << as_json(record, simulation, options).dump(2) << '\n';
  else print_table(context.out, record, simulation, options);
  return 0;
}

}  // namespace insula
