// SPDX-License-Identifier: GPL-3.0-or-later
// insula bench --solvers: the solvers side by side on the same recorded step, each on one thread.
#include <fmt/ostream.h>

#include <chrono>
#include <nlohmann/json.hpp>

#include "core/linalg/direct_solver.h"
#include "core/linalg/kernels.h"
#include "core/linalg/opencl_solver.h"
#include "core/mechanics/deformable_body.h"
#include "tools/workbench/machine_rates.h"
#include "tools/workbench/measured_run.h"
#include "tools/workbench/reference_solvers.h"
#include "tools/workbench/scaling_scene.h"
#include "tools/workbench/workbench.h"

namespace insula {
namespace {

/// One body's part of the step.
struct Recorded {
  const DeformableBody* body;
  BodyRows rows;
  int compared;  ///< columns of W held against the reference
  VecX b, x;     ///< a right-hand side and its solution
  MatX w;        ///< rows x compared
};

// x with A x = b to the last digit: refined with residuals in extended precision.
VecX refined(ComplianceSolver& solver, const BlockMatrix& a, const VecX& b) {
  using Long = Eigen::Matrix<long double, 3, 1>;
  VecX x = VecX::Zero(b.size());
  Eigen::Matrix<long double, Eigen::Dynamic, 1> r(b.size()), sum = x.cast<long double>();
  for (int round = 0; round < 4; ++round) {
    r = b.cast<long double>();
    for (int j = 0; j < a.nodes(); ++j)
      for (int s = a.column_start(j); s < a.column_start(j + 1); ++s) {
        const Eigen::Matrix<long double, 3, 3> block = Eigen::Map<const Mat3>(a.block(s)).cast<long double>();
        const int i = a.row(s);
        r.segment<3>(3 * i) -= Long(block * sum.segment<3>(3 * j));
        if (i != j) r.segment<3>(3 * j) -= Long(block.transpose() * sum.segment<3>(3 * i));
      }
    x = r.cast<double>();
    solver.solve(x.data());
    sum += x.cast<long double>();
  }
  return sum.cast<double>();
}

Recorded record(const DeformableBody& body, int max_rows) {
  const BlockMatrix& a = body.system();
  const std::vector<int>& node = body.free_of_node();
  Recorded out{&body, {}, 0, VecX(3 * a.nodes()), {}, {}};
  out.rows.clear();
  const int m = max_rows > 0 ? std::min(max_rows, body.rows.count()) : body.rows.count();
  for (int r = 0; r < m; ++r) {
    out.rows.open(r);
    for (int e = body.rows.start[std::size_t(r)]; e < body.rows.start[std::size_t(r) + 1]; ++e)
      out.rows.add(body.rows.block[std::size_t(e)], body.rows.coeff[std::size_t(e)]);
  }
  const auto solver = make_direct_solver(false);
  solver->analyse(a);
  if (!solver->factorise(a)) throw std::runtime_error("the matrix of \"" + body.id + "\" is not positive definite");
  for (int i = 0; i < 3 * a.nodes(); ++i) out.b[i] = i % 3 == 0 ? 1 : i % 3 == 1 ? 0.5 : -0.25;
  out.x = refined(*solver, a, out.b);
  out.compared = a.nodes() > 3000 ? std::min(m, 8) : m;
  out.w.resize(m, out.compared);
  const auto column_of = [&](int r, auto&& f) {
    for (int e = out.rows.start[std::size_t(r)]; e < out.rows.start[std::size_t(r) + 1]; ++e)
      if (const int n = node[std::size_t(out.rows.block[std::size_t(e)])]; n >= 0) f(n, out.rows.coeff[std::size_t(e)]);
  };
  for (int c = 0; c < out.compared; ++c) {
    const int row = c * m / out.compared;  // spread over all of them
    VecX h = VecX::Zero(3 * a.nodes());
    column_of(row, [&](int n, const Vec3& d) { h.segment<3>(3 * n) += d; });
    const VecX x = refined(*solver, a, h);
    for (int r = 0; r < m; ++r) {
      double sum = 0;
      column_of(r, [&](int n, const Vec3& d) { sum += d.dot(x.segment<3>(3 * n)); });
      out.w(r, c) = sum;
    }
  }
  return out;
}

/// A brick of about that many nodes, with a small one above it and taut fibres between them.
OpenedRun open_brick(const CommandContext& context, const BenchOptions& options) {
  Bricks bricks;
  bricks.cells = std::max(2, int(std::lround(std::cbrt(double(options.nodes)))) - 1);
  bricks.upper_cells = 4;
  bricks.fibres = 40;
  OpenedRun out;
  out.simulation = brick_scene(bricks, context.registry, options.threads);
  return out;
}

struct NamedSolver {
  std::string name;
  std::unique_ptr<ComplianceSolver> solver;
};

struct Measured {
  std::string name;
  double factor_ms = 1e300, solve_ms = 1e300, w_ms = 1e300;
  double again_ms = 1e300;              ///< W of the same rows with the same factor
  double solve_error = 0, w_error = 0;  ///< largest, over the largest value
  SolverCost cost;
};

template <class F>
double milliseconds(F&& f) {
  const auto begin = std::chrono::steady_clock::now();
  f();
  return std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - begin).count();
}

// In rounds, all solvers in each round: what disturbs the machine disturbs them all. The fastest run counts.
std::vector<Measured> measure(const Recorded& step, const std::vector<NamedSolver>& solvers) {
  constexpr double budget_ms = 1000;  // of each solver
  const BlockMatrix& a = step.body->system();
  const int least = a.nodes() > 20000 ? 2 : 3, most = 300;
  const std::vector<int>& node = step.body->free_of_node();
  const int m = step.rows.count(), stride = std::max(8, (m + 7) & ~7);
  std::vector<Measured> out(solvers.size());
  VecX x;
  std::vector<double> w(std::size_t(stride) * std::size_t(stride)), spent(solvers.size(), 0.0);
  for (std::size_t i = 0; i < solvers.size(); ++i) {
    out[i].name = solvers[i].name;
    solvers[i].solver->analyse(a);
  }
  for (int k = 0; k < most; ++k)
    for (std::size_t i = 0; i < solvers.size(); ++i) {
      if (k >= least && spent[i] > budget_ms) continue;
      ComplianceSolver& s = *solvers[i].solver;
      const auto timed = [&](double& best, auto&& f) {
        const double ms = milliseconds(f);
        spent[i] += ms;
        best = std::min(best, ms);
      };
      const auto compliance = [&] {
        s.compute_compliance(step.rows, node);
        s.add_compliance(step.rows, w.data(), stride);
      };
      timed(out[i].factor_ms, [&] {
        if (!s.factorise(a))
          throw std::runtime_error(solvers[i].name + " calls the matrix of \"" + step.body->id + "\" indefinite");
      });
      x = step.b;
      timed(out[i].solve_ms, [&] { s.solve(x.data()); });
      timed(out[i].w_ms, compliance);
      out[i].cost = s.cost();
      timed(out[i].again_ms, compliance);
    }
  for (std::size_t i = 0; i < solvers.size(); ++i) {
    ComplianceSolver& s = *solvers[i].solver;
    x = step.b;
    s.solve(x.data());
    out[i].solve_error = (x - step.x).cwiseAbs().maxCoeff() / step.x.cwiseAbs().maxCoeff();
    if (m == 0) continue;
    std::fill(w.begin(), w.end(), 0.0);
    s.add_compliance(step.rows, w.data(), stride);
    double error = 0;
    for (int r = 0; r < m; ++r)
      for (int c = 0; c < step.compared; ++c)
        error = std::max(error, std::abs(w[std::size_t(r * stride + c * m / step.compared)] - step.w(r, c)));
    out[i].w_error = error / step.w.cwiseAbs().maxCoeff();
  }
  return out;
}

struct NamedLibrary {
  std::string name;
  std::shared_ptr<const CholmodLibrary> cholmod;
};

/// CHOLMOD on the installed BLAS libraries and on the one of the options; remarks on those that are missing.
std::vector<NamedLibrary> load_libraries(const std::filesystem::path& extra, std::vector<std::string>& remarks) {
  InstalledBlas blas = installed_blas();
  if (!extra.empty()) {
    blas.found.push_back({extra.string(), extra});
    std::erase_if(blas.missing, [](const std::string& s) { return s.starts_with("OpenBLAS"); });
  }
  if (blas.found.empty()) blas.found.push_back({"BLAS of the system", {}});
  remarks = std::move(blas.missing);
  std::vector<NamedLibrary> out;
  for (const BlasFolder& b : blas.found) {
    NamedLibrary one{b.name, load_cholmod(b.folder)};
    if (one.cholmod->blas.starts_with("OpenBLAS")) one.name = "OpenBLAS";
    out.push_back(std::move(one));
  }
  return out;
}

std::vector<NamedSolver> all_solvers(const std::vector<NamedLibrary>& libraries, bool ours_only) {
  std::vector<NamedSolver> out;
  out.push_back({"direct", make_direct_solver(false)});
  out.push_back({"direct, single precision", make_direct_solver(true)});
  if (const std::vector<std::string> devices = opencl_devices(); !devices.empty())
    out.push_back({"OpenCL, " + devices.front(), make_opencl_solver()});
  if (ours_only) return out;
  for (const NamedLibrary& l : libraries) {
    out.push_back({"CHOLMOD, " + l.name, make_cholmod_solver(l.cholmod, ReferenceW::full)});
    out.push_back({"CHOLMOD, " + l.name + ", forward W", make_cholmod_solver(l.cholmod, ReferenceW::forward)});
  }
  out.push_back({"Eigen LDLT", make_eigen_solver()});
  return out;
}

bool is_single(const Measured& s) { return s.name.find("single") != std::string::npos; }

nlohmann::json as_json(const Measured& s, const MachineRates& machine) {
  const double product = is_single(s) ? machine.product_f32 : machine.product_f64;
  const double factor_rate = s.cost.factor_flops / (s.factor_ms * 1e-3),
               w_rate = s.cost.compliance_flops / (s.w_ms * 1e-3);
  const double read = s.cost.factor_bytes / (s.solve_ms * 1e-3);
  nlohmann::json j{{"solver", s.name},
                   {"factor_ms", s.factor_ms},
                   {"solve_ms", s.solve_ms},
                   {"w_ms", s.w_ms},
                   {"w_again_ms", s.again_ms},
                   {"solve_error", s.solve_error},
                   {"w_error", s.w_error},
                   {"factor_entries", s.cost.factor_entries},
                   {"factor_flops", s.cost.factor_flops},
                   {"w_flops", s.cost.compliance_flops},
                   {"solve_bytes", s.cost.factor_bytes},
                   {"factor_share_of_product", factor_rate / product},
                   {"w_share_of_product", w_rate / product},
                   {"solve_share_of_read", read / machine.read}};
  return j;
}

void print(std::ostream& out, const Recorded& step, const std::vector<Measured>& all, const MachineRates& machine) {
  fmt::print(out, "\n{}: {} free nodes, {} rows\n", step.body->id, step.body->system().nodes(), step.rows.count());
  fmt::print(out, "  {:<36}{:>10}{:>10}{:>10}{:>10}{:>11}{:>11}{:>10}{:>11}{:>7}{:>7}{:>7}\n", "solver", "factor ms",
             "solve ms", "W ms", "W again", "err solve", "err W", "entries", "fac Mflop", "fac %", "W %", "read %");
  for (const Measured& s : all) {
    const nlohmann::json j = as_json(s, machine);
    fmt::print(
        out, "  {:<36}{:>10.3f}{:>10.3f}{:>10.3f}{:>10.3f}{:>11.1e}{:>11.1e}{:>10}{:>11.1f}{:>7.0f}{:>7.0f}{:>7.0f}\n",
        s.name, s.factor_ms, s.solve_ms, s.w_ms, s.again_ms, s.solve_error, s.w_error, s.cost.factor_entries,
        s.cost.factor_flops * 1e-6, 100 * j["factor_share_of_product"].get<double>(),
        100 * j["w_share_of_product"].get<double>(), 100 * j["solve_share_of_read"].get<double>());
  }
  const Measured& ours = all.front();
  for (const Measured& s : all)
    if (&s != &ours)
      fmt::print(out, "  {} over {}: factor {:.1f}, W {:.1f}, factor and W {:.1f}\n", s.name, ours.name,
                 s.factor_ms / ours.factor_ms, s.w_ms / ours.w_ms,
                 (s.factor_ms + s.w_ms) / (ours.factor_ms + ours.w_ms));
}

}  // namespace

int cmd_bench_solvers(const CommandContext& context, const BenchOptions& options) {
  const OpenedRun opened = options.nodes > 0 ? open_brick(context, options) : open_for_measuring(context, options);
  if (!opened.simulation) return 2;
  std::vector<std::string> remarks;
  std::vector<NamedLibrary> libraries;
  try {
    if (options.nodes == 0) libraries = load_libraries(options.blas, remarks);
  } catch (const std::exception& e) {
    context.err << "error: CHOLMOD cannot be loaded on another BLAS: " << e.what() << '\n';
    return 2;
  }
  HeadlessRun run(*opened.simulation, opened.motion);
  warm_up(run, options, opened.simulation->h());

  const MachineRates machine = measure_machine();
  nlohmann::json j;
  const std::string scene =
      options.nodes > 0 ? fmt::format("a brick of about {} nodes", options.nodes) : options.scene.string();
  j["scene"] = scene;
  j["time_s"] = opened.simulation->time();
  j["kernels"] = kernels().name;
  for (const NamedLibrary& l : libraries) j["blas"].push_back({{"name", l.name}, {"library", l.cholmod->blas}});
  j["remarks"] = remarks;
  j["machine"] = {{"peak_f64", machine.peak_f64},
                  {"peak_f32", machine.peak_f32},
                  {"product_f64", machine.product_f64},
                  {"product_f32", machine.product_f32},
                  {"read", machine.read}};
  if (!options.json) {
    fmt::print(context.out,
               "{} at {:.2f} s  ({} kernels, one thread)\n"
               "this core, Gflop/s: peak {:.0f} (single {:.0f}), dense product of our kernels {:.0f} (single {:.0f}); "
               "reads {:.1f} GB/s\n"
               "%: of the rate of the dense product; of the rate of reading\n",
               scene, opened.simulation->time(), kernels().name, machine.peak_f64 * 1e-9, machine.peak_f32 * 1e-9,
               machine.product_f64 * 1e-9, machine.product_f32 * 1e-9, machine.read * 1e-9);
    for (const NamedLibrary& l : libraries) fmt::print(context.out, "{}: {}\n", l.name, l.cholmod->blas);
    for (const std::string& remark : remarks) fmt::print(context.out, "{}\n", remark);
  }
  for (const Body* b : opened.simulation->bodies()) {
    const auto* body = dynamic_cast<const DeformableBody*>(b);
    if (!body || body->system().nodes() == 0) continue;
    const Recorded step = record(*body, options.rows);
    const std::vector<Measured> all = measure(step, all_solvers(libraries, options.nodes > 0));
    nlohmann::json of_body{{"body", body->id}, {"nodes", body->system().nodes()}, {"rows", step.rows.count()}};
    for (const Measured& s : all) of_body["solvers"].push_back(as_json(s, machine));
    j["bodies"].push_back(of_body);
    if (!options.json) print(context.out, step, all, machine);
  }
  if (options.json) context.out << j.dump(2) << '\n';
  return 0;
}

}  // namespace insula
