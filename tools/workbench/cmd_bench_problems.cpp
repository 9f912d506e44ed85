// SPDX-License-Identifier: GPL-3.0-or-later
// insula bench --record and --problems: constraint problems of a scene as files, and how fast and how well they are
// solved.
#include <fmt/ostream.h>

#include <chrono>
#include <map>

#include "core/base/input_error.h"
#include "core/base/random.h"
#include "core/constraint/problem_file.h"
#include "core/constraint/solve.h"
#include "core/linalg/kernels.h"
#include "engine/reports/report_writer.h"
#include "tools/workbench/measured_run.h"
#include "tools/workbench/workbench.h"

namespace insula {
namespace {

double microseconds(std::chrono::steady_clock::duration d) {
  return std::chrono::duration<double, std::micro>(d).count();
}

// --- the recorded set
// --------------------------------------------------------------------------------------------------

struct Method {
  const char* name;
  SolveSettings settings;
};

struct Outcome {
  std::vector<double> us, sweeps, newton;
  double residual_m = 0, residual_N = 0;
  int above = 0;  // problems that ended above the tolerance
};

Outcome solve_all(const std::vector<ConstraintProblem>& problems, const SolveSettings& settings, int repeats) {
  Outcome out;
  SolveWorkspace ws;
  for (const ConstraintProblem& p : problems) {
    ws.reserve(p.rows);
    double best = 1e300;
    SolveStats stats;
    for (int k = 0; k < repeats; ++k) {
      ws.lambda.assign(p.lambda.begin(), p.lambda.end());
      const auto begin = std::chrono::steady_clock::now();
      stats = solve(p, p.delta_free, settings, ws);
      best = std::min(best, microseconds(std::chrono::steady_clock::now() - begin));
    }
    out.us.push_back(best);
    out.sweeps.push_back(stats.sweeps);
    out.newton.push_back(stats.newton_steps);
    out.residual_m = std::max(out.residual_m, stats.residual_m);
    out.residual_N = std::max(out.residual_N, stats.residual_N);
    out.above += stats.residual_m > settings.tolerance_m;
  }
  return out;
}

// --- the rate of sweeps
// -------------------------------------------------------------------------------------------------

/// Dense, random, badly conditioned, so that every row goes on moving.
ConstraintProblem dense_problem(int rows, LawKind law) {
  Random random(5);
  ConstraintProblem p;
  p.resize(rows);
  const int m = rows * 2 / 3;
  std::vector<double> h(std::size_t(rows * m));
  for (double& x : h) x = random.uniform(-1, 1);
  for (int i = 0; i < rows; ++i)
    for (int j = 0; j <= i; ++j) {
      double sum = i == j ? 0.002 : 0;
      for (int k = 0; k < m; ++k) sum += h[std::size_t(i * m + k)] * h[std::size_t(j * m + k)] / m;
      p.w[std::size_t(i * p.stride + j)] = p.w[std::size_t(j * p.stride + i)] = sum;
    }
  for (double& d : p.delta_free) d = random.uniform(-1, 1);
  for (int row = 0; row < rows;) {
    Block b;
    b.id = std::uint64_t(row);
    b.row = row;
    b.law = law;
    if (law == LawKind::friction) b.friction = 0.3;
    else b.lower = 0;
    p.blocks.push_back(b);
    row += b.rows();
  }
  return p;
}

/// Sweeps a millisecond, the best of many short runs: what 21 sweeps take longer than one.
double sweep_rate(int rows, LawKind law) {
  const ConstraintProblem p = dense_problem(rows, law);
  SolveWorkspace ws;
  ws.reserve(rows);
  ws.lambda.assign(std::size_t(rows), 0.0);
  solve(p, p.delta_free, {3, -1.0}, ws);
  const std::vector<double> start = ws.lambda;
  double best[2] = {1e300, 1e300};
  for (int k = 0; k < 300; ++k)
    for (int which = 0; which < 2; ++which) {
      ws.lambda = start;
      const auto begin = std::chrono::steady_clock::now();
      solve(p, p.delta_free, {which ? 21 : 1, -1.0}, ws);
      best[which] = std::min(best[which], microseconds(std::chrono::steady_clock::now() - begin));
    }
  return 20e3 / (best[1] - best[0]);
}

}  // namespace

int cmd_record_problems(const CommandContext& context, const BenchOptions& options) {
  const OpenedRun opened = open_for_measuring(context, options);
  if (!opened.simulation) return 2;
  std::error_code error;
  std::filesystem::create_directories(options.record, error);
  if (error) {
    context.err << options.record.string() << ": error: " << error.message() << '\n';
    return 1;
  }
  Simulation& simulation = *opened.simulation;
  HeadlessRun run(simulation, opened.motion);
  const auto first = std::int64_t(options.from / simulation.h());
  std::map<std::uint64_t, std::vector<double>> last;  // lambda of the step before: the warm start
  int written = 0;
  for (std::int64_t k = 0; k < first + options.steps; ++k) {
    run.step();
    ConstraintProblem p = simulation.problem();
    std::map<std::uint64_t, std::vector<double>> now;
    for (const Block& b : p.blocks) {
      const auto at = p.lambda.begin() + b.row;
      now[b.id].assign(at, at + b.rows());
      const auto known = last.find(b.id);
      for (int i = 0; i < b.rows(); ++i)
        p.lambda[std::size_t(b.row + i)] =
            known != last.end() && int(known->second.size()) == b.rows() ? known->second[std::size_t(i)] : 0;
    }
    last = std::move(now);
    if (k < first || (k - first) % options.every != 0 || p.rows == 0) continue;
    const std::string motion = std::filesystem::path(options.motion).stem().string();
    try {
      write_problem(options.record / fmt::format("{}_{}_{:06}.problem", options.scene.stem().string(), motion, k), p);
    } catch (const InputError& e) {
      context.err << "error: " << e.what() << '\n';
      return 1;
    }
    ++written;
  }
  fmt::print(context.out, "{} problems written to {}\n", written, options.record.string());
  return 0;
}

int cmd_bench_problems(const CommandContext& context, const BenchOptions& options) {
  std::vector<ConstraintProblem> problems;
  try {
    for (const auto& file : problem_files(options.problems)) problems.push_back(read_problem(file));
  } catch (const InputError& e) {
    context.err << "error: " << e.what() << '\n';
    return 2;
  }
  std::vector<double> rows;
  for (const ConstraintProblem& p : problems) rows.push_back(p.rows);
  constexpr double tolerance = 1e-8;
  const Method methods[] = {{"sweeps", {2000, tolerance, false, 0}},
                            {"conjugate sweeps", {2000, tolerance, true, 0}},
                            {"sweeps, Newton", {150, tolerance, false, 20}},
                            {"conjugate, Newton", {150, tolerance, true, 20}},
                            {"Newton at once", {1, tolerance, false, 20}}};
  fmt::print(context.out, "{} problems of {}, {:.0f} rows at the median, {:.0f} at most; {} kernels; to {:.0e} m\n\n",
             problems.size(), options.problems.string(), percentile(rows, 0.5), percentile(rows, 1), kernels().name,
             tolerance);
  fmt::print(context.out, "  {:<20}{:>27}{:>24}{:>15}{:>21}\n", "", "us a solve", "sweeps", "Newton steps",
             "residual, most");
  fmt::print(context.out, "  {:<20}{:>9}{:>9}{:>9}{:>8}{:>8}{:>8}{:>15}{:>12}{:>9}{:>8}\n", "method", "p50", "p95",
             "max", "p50", "p95", "max", "max", "m", "N", "above");
  for (const Method& m : methods) {
    const Outcome o = solve_all(problems, m.settings, 3);
    fmt::print(context.out, "  {:<20}{:>9.1f}{:>9.1f}{:>9.1f}{:>8.0f}{:>8.0f}{:>8.0f}{:>15.0f}{:>12.1e}{:>9.1e}{:>8}\n",
               m.name, percentile(o.us, 0.5), percentile(o.us, 0.95), percentile(o.us, 1), percentile(o.sweeps, 0.5),
               percentile(o.sweeps, 0.95), percentile(o.sweeps, 1), percentile(o.newton, 1), o.residual_m, o.residual_N,
               o.above);
  }
  fmt::print(context.out, "\n  {:<28}{:>10}{:>10}\n", "sweeps/ms, random, dense", "120 rows", "360 rows");
  fmt::print(context.out, "  {:<28}{:>10.0f}{:>10.0f}\n", "contacts without friction", sweep_rate(120, LawKind::box),
             sweep_rate(360, LawKind::box));
  fmt::print(context.out, "  {:<28}{:>10.0f}{:>10.0f}\n", "contacts with friction", sweep_rate(120, LawKind::friction),
             sweep_rate(360, LawKind::friction));
  return 0;
}

}  // namespace insula
