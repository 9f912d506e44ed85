// SPDX-License-Identifier: GPL-3.0-or-later
// Which solver a body gets.
#include "core/linalg/opencl_solver.h"

#include <algorithm>
#include <chrono>

#include "core/linalg/direct_solver.h"
#include "core/linalg/opencl/guarded_solver.h"

namespace insula {
namespace {

using opencl::DeviceFailure;
using opencl::GuardedSolver;

/// A positive definite matrix: each node is held, and pulled towards its neighbours.
BlockMatrix trial_matrix(const BlockMatrix& pattern) {
  BlockMatrix a = pattern;
  a.set_zero();
  const auto add = [&](int slot, double value) {
    for (int k = 0; k < 3; ++k) a.block(slot)[4 * k] += value;
  };
  for (int j = 0; j < a.nodes(); ++j)
    for (int s = a.column_start(j); s < a.column_start(j + 1); ++s) {
      const int i = a.row(s);
      add(s, i == j ? 1 : -1);
      if (i == j) continue;
      add(a.diagonal(i), 1);
      add(a.diagonal(j), 1);
    }
  return a;
}

BodyRows trial_rows(int nodes) {
  constexpr int rows = 96, nodes_of_row = 3;
  BodyRows h;
  h.clear();
  for (int r = 0; r < rows; ++r) {
    h.open(r);
    for (int k = 0; k < nodes_of_row; ++k)
      h.add(int((std::int64_t(r) * nodes / rows + k) % nodes), Vec3(1, 0.5, -0.25));
  }
  return h;
}

/// The shortest of up to three steps, s. Ends when one was longer than `enough`. Negative: the solver failed.
double time_of_step(BodySolver& solver, const BlockMatrix& a, double enough) {
  using Clock = std::chrono::steady_clock;
  const BodyRows rows = trial_rows(a.nodes());
  std::vector<int> node(std::size_t(a.nodes()));
  for (int i = 0; i < a.nodes(); ++i) node[std::size_t(i)] = i;
  const int m = rows.count();
  const VecX load = VecX::Ones(3 * a.nodes()), lambda = VecX::Ones(m);
  std::vector<double> w(std::size_t(m) * std::size_t(m)), delta(std::size_t(m), 0.0);
  VecX x = load;
  solver.analyse(a);
  double best = -1;
  for (int run = 0; run < 3 && (best < 0 || best < enough); ++run) {
    const auto begin = Clock::now();
    if (!solver.begin_motion(&a, load, load)) return -1;
    solver.compute_compliance(rows, node);
    solver.add_compliance(rows, w.data(), m);
    solver.add_free_motion(rows, delta.data());
    solver.end_motion(rows, lambda.data(), x);
    const double seconds = std::chrono::duration<double>(Clock::now() - begin).count();
    best = best < 0 ? seconds : std::min(best, seconds);
  }
  return best;
}

}  // namespace

std::vector<std::string> opencl_devices() {
  std::vector<std::string> names;
  for (const opencl::FoundDevice& d : opencl::find_devices()) names.push_back(d.name);
  return names;
}

std::unique_ptr<BodySolver> make_opencl_solver() {
  if (!opencl::api()) throw NoDevice("there is no OpenCL library (libOpenCL.so.1) on this machine");
  const std::vector<opencl::FoundDevice> devices = opencl::find_devices();
  if (devices.empty()) throw NoDevice("OpenCL offers no device with double precision and a compiler");
  try {
    return std::make_unique<GuardedSolver>(devices.front());
  } catch (const DeviceFailure& e) {
    throw NoDevice(devices.front().name + " cannot be used: " + e.what());
  }
}

SolverTrial try_solvers(const BlockMatrix& pattern) {
  SolverTrial out;
  if (pattern.nodes() == 0 || opencl::find_devices().empty()) return out;
  try {
    const std::unique_ptr<BodySolver> device = make_opencl_solver(), processor = make_direct_solver(false);
    const BlockMatrix a = trial_matrix(pattern);
    out.processor_s = time_of_step(*processor, a, 10);
    const double seconds = time_of_step(*device, a, 4 * out.processor_s);
    if (!device_lost(*device)) out.device_s = seconds;
  } catch (const NoDevice&) {
    out = {};
  }
  return out;
}

std::unique_ptr<BodySolver> make_faster_solver(const BlockMatrix& pattern) {
  return try_solvers(pattern).device_is_faster() ? make_opencl_solver() : make_direct_solver(false);
}

std::string device_of(const BodySolver& solver) {
  const auto* guarded = dynamic_cast<const GuardedSolver*>(&solver);
  return guarded ? guarded->device_name() : std::string();
}

bool device_lost(const BodySolver& solver) {
  const auto* guarded = dynamic_cast<const GuardedSolver*>(&solver);
  return guarded && guarded->device_lost();
}

}  // namespace insula
