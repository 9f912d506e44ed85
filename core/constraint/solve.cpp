// SPDX-License-Identifier: GPL-3.0-or-later
// Block Gauss-Seidel with residual updates (core/constraint/sweep_kernels.h), then, where it stalls, Newton
// (core/constraint/newton.h).
//
// On request lambda is extrapolated between sweeps along a conjugate direction (nonsmooth nonlinear conjugate
// gradients; Silcowitz, Niebe, Erleben 2010). With g the change of lambda in a sweep:
//   beta = |g_k|^2 / |g_k-1|^2,   p_k = beta p_k-1 + g_k,   lambda += beta p_k-1
// The direction starts again if beta > 1. A stiff clip on a thin wall needs a tenth of the sweeps. W p follows from
// the deltas before and after a sweep, so it costs no product with W. The last operation on lambda is always a sweep,
// which keeps every law.
#include "core/constraint/solve.h"

#include <algorithm>
#include <cmath>

#include "core/constraint/sweep.h"

namespace insula {

void SolveWorkspace::reserve(int rows, bool with_newton) {
  const std::size_t n = std::size_t(rows) + 8;
  for (std::vector<double>* v : {&lambda, &delta, &before, &before_delta, &along, &along_delta})
    if (v->capacity() < n) v->reserve(n);
  if (current.capacity() < n) current.reserve(n);
  sweep.reserve(rows);
  if (with_newton) newton.reserve(rows);
}

void full_delta(const ConstraintProblem& p, std::span<const double> free, const double* lambda,
                AlignedVector<double>& delta) {
  delta.assign(std::size_t(p.stride), 0.0);
  std::copy(free.begin(), free.end(), delta.begin());
  sweep_kernels().combine(delta.data(), p.w.data(), p.stride, lambda, p.rows, p.stride);
}

namespace {

// Moves lambda and delta along the conjugate direction after a sweep. Returns the size of the sweep's change.
double carry_on(const ConstraintProblem& p, SolveWorkspace& ws, double last_norm) {
  const std::size_t n = std::size_t(p.rows), diagonal = std::size_t(p.stride) + 1;
  double norm = 0;
  for (std::size_t i = 0; i < n; ++i) {
    const double g = ws.lambda[i] - ws.before[i];
    norm += g * g * p.w[i * diagonal];
  }
  const double beta = last_norm > 0 ? norm / last_norm : 2;
  const bool anew = !(beta <= 1);
  for (std::size_t i = 0; i < n; ++i) {
    const double g = ws.lambda[i] - ws.before[i], wg = ws.current[i] - ws.before_delta[i];
    if (anew) {
      ws.along[i] = g;
      ws.along_delta[i] = wg;
      continue;
    }
    ws.along[i] *= beta;
    ws.along_delta[i] *= beta;
    ws.lambda[i] += ws.along[i];
    ws.current[i] += ws.along_delta[i];
    ws.along[i] += g;
    ws.along_delta[i] += wg;
  }
  return norm;
}

void measure_residual(const ConstraintProblem& p, const double* lambda, const double* delta, SolveStats& stats) {
  stats.residual_m = stats.residual_N = 0;
  double next[3];
  for (const Block& b : p.blocks) {
    local_solution(p, b, lambda, delta, next);
    for (int i = 0; i < b.rows(); ++i) {
      const double d = std::abs(next[i] - lambda[b.row + i]);
      stats.residual_N = std::max(stats.residual_N, d);
      stats.residual_m = std::max(stats.residual_m, d * p.w_at(b.row + i, b.row + i));
    }
  }
}

// Forecasts that sweeps will not reach the tolerance, if their changes decrease too slowly from one window of sweeps to
// the next.
class Forecast {
 public:
  Forecast(const SolveSettings& s) : settings_(s) {}
  bool stalls(int sweeps, double moved) {
    max_moved_ = std::max(max_moved_, moved);
    if (settings_.max_newton <= 0) return false;
    if (settings_.newton_soon && sweeps >= window / 2) return true;
    if (sweeps % window != 0) return false;
    const double share = last_ > 0 ? max_moved_ / last_ : 0;
    last_ = max_moved_;
    max_moved_ = 0;
    if (share <= 0) return false;
    if (share >= 1) return sweeps >= 4 * window;  // at first a warm start may be far from the solution
    return sweeps + window * std::log(settings_.tolerance_m / last_) / std::log(share) > 2.0 * settings_.max_sweeps;
  }

 private:
  static constexpr int window = 16;
  const SolveSettings& settings_;
  double max_moved_ = 0, last_ = 0;
};

// Sweeps until the change is below the tolerance, the number of sweeps is reached, or a stall is forecast.
void sweep_on(const ConstraintProblem& p, const SolveSettings& settings, const SweepData& data, SolveWorkspace& ws,
              SolveStats& stats) {
  const int n = p.rows;
  double* lambda = ws.lambda.data();
  const auto sweep = sweep_kernels().sweep;
  Forecast forecast(settings);
  for (std::vector<double>* v : {&ws.before, &ws.before_delta, &ws.along, &ws.along_delta})
    v->assign(std::size_t(n), 0.0);
  double last_norm = 0;  // of the last sweep, 0: no direction yet
  while (stats.sweeps < settings.max_sweeps) {
    if (settings.conjugate) {
      std::copy_n(lambda, n, ws.before.data());
      std::copy_n(ws.current.data(), n, ws.before_delta.data());
    }
    const double moved = sweep(data, lambda, ws.current.data());
    ++stats.sweeps;
    if (moved <= settings.tolerance_m || stats.sweeps >= settings.max_sweeps || forecast.stalls(stats.sweeps, moved))
      break;
    if (settings.conjugate) last_norm = carry_on(p, ws, last_norm);
  }
}

// Makes some more sweeps. Keeps the old lambda if its residual was smaller.
void sweep_more(const ConstraintProblem& p, std::span<const double> free, SolveSettings settings, int count,
                bool conjugate, const SweepData& data, SolveWorkspace& ws, SolveStats& stats) {
  NewtonMemory& m = ws.newton;
  m.trial.assign(ws.lambda.begin(), ws.lambda.end());
  full_delta(p, free, ws.lambda.data(), ws.current);
  settings.max_sweeps = stats.sweeps + count;
  settings.conjugate = conjugate;
  settings.max_newton = 0;
  sweep_on(p, settings, data, ws, stats);
  SolveStats reached;
  full_delta(p, free, ws.lambda.data(), ws.current);
  measure_residual(p, ws.lambda.data(), ws.current.data(), reached);
  if (reached.residual_m <= stats.residual_m) stats.residual_m = reached.residual_m;
  else ws.lambda.assign(m.trial.begin(), m.trial.end());
}

constexpr double shortest_step = 0.1;  // smallest fraction of a Newton step that is tried
constexpr int smoothing = 3;           // sweeps after a Newton step
constexpr double min_proximal = 1e-11, max_proximal = 1;

double largest(std::span<const double> lambda) {
  double out = 0;
  for (const double x : lambda) out = std::max(out, std::abs(x));
  return out;
}

// Newton's method from the sweeps' result, which is kept unless a better one is found. Where rows depend on one
// another, W has a null space. A step along it changes no delta, so the residual does not see it, however large the
// forces are.
void newton_on(const ConstraintProblem& p, std::span<const double> free, const SolveSettings& settings,
               const SweepData& data, SolveWorkspace& ws, SolveStats& stats) {
  const auto sweep = sweep_kernels().sweep;
  const std::size_t n = std::size_t(p.rows);
  NewtonMemory& m = ws.newton;
  double proximal = min_proximal;
  while (stats.residual_m > settings.tolerance_m && stats.newton_steps < settings.max_newton) {
    ++stats.newton_steps;
    bool better = false;
    full_delta(p, free, ws.lambda.data(), ws.current);
    if (newton_target(p, free, ws.lambda.data(), ws.current.data(), proximal, settings.newton_unknowns, m)) {
      m.base.assign(m.trial.begin(), m.trial.end());  // the result of a full step
      for (double step = 1; step > shortest_step && !better; step *= 0.4) {
        for (std::size_t i = 0; i < n; ++i) m.trial[i] = ws.lambda[i] + step * (m.base[i] - ws.lambda[i]);
        put_into_bounds(p, m.trial.data());
        full_delta(p, free, m.trial.data(), ws.current);
        for (int k = 0; k < smoothing; ++k) sweep(data, m.trial.data(), ws.current.data());
        stats.sweeps += smoothing;
        SolveStats reached;
        full_delta(p, free, m.trial.data(), ws.current);
        measure_residual(p, m.trial.data(), ws.current.data(), reached);
        if (!(reached.residual_m < 0.9 * stats.residual_m) || !(largest({m.trial.data(), n}) <= settings.newton_bound))
          continue;
        better = true;
        stats.residual_m = reached.residual_m;
        stats.method = SolveMethod::newton;
        ws.lambda.assign(m.trial.begin(), m.trial.end());
      }
    }
    proximal = better ? std::max(min_proximal, 0.1 * proximal) : 100 * proximal;
    if (better) continue;
    if (settings.newton_sweeps <= 0) return;
    if (proximal > max_proximal) proximal = min_proximal;  // sweeps have changed lambda meanwhile
    sweep_more(p, free, settings, settings.newton_sweeps, true, data, ws, stats);
  }
}

}  // namespace

SolveStats solve(const ConstraintProblem& p, std::span<const double> free, const SolveSettings& settings,
                 SolveWorkspace& ws) {
  const std::size_t n = std::size_t(p.rows);
  ws.lambda.resize(n);
  ws.delta.resize(n);
  SolveStats stats;
  if (n == 0) return stats;
  free = free.first(n);
  full_delta(p, free, ws.lambda.data(), ws.current);
  const SweepData data = ws.sweep.set_up(p);
  sweep_on(p, settings, data, ws, stats);

  // Residual for a new delta: the change that each law would still make.
  const auto finish = [&] {
    full_delta(p, free, ws.lambda.data(), ws.current);
    measure_residual(p, ws.lambda.data(), ws.current.data(), stats);
  };
  finish();
  if (settings.max_newton > 0 && stats.residual_m > settings.tolerance_m) {
    const int sweeps = stats.sweeps;
    stats.stalled = true;
    newton_on(p, free, settings, data, ws, stats);
    finish();
    if (stats.residual_m > settings.tolerance_m &&
        sweeps < settings.max_sweeps) {  // the forecast was wrong: the remaining sweeps
      sweep_more(p, free, settings, settings.max_sweeps - sweeps, settings.conjugate, data, ws, stats);
      finish();
    }
  }
  std::copy_n(ws.current.begin(), n, ws.delta.begin());
  return stats;
}

}  // namespace insula
