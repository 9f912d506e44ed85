// SPDX-License-Identifier: GPL-3.0-or-later
// Modes from a block Krylov space.
#include "core/haptics/reduced_basis.h"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>

namespace insula {
namespace {

constexpr double dependent = 1e-10;  // of the largest eigenvalue: directions that others have already

void gather(const DeformableBody& body, const VecX& nodes, VecX& free) {
  for (int i = 0; i < body.nodes(); ++i)
    if (const int b = body.free_of_node()[std::size_t(i)]; b >= 0) free.segment<3>(3 * b) = nodes.segment<3>(3 * i);
}

}  // namespace

// Loads of a tool: 3 uniform ones and 9 that are linear in the position. Those with the largest compliance are added.
void ReducedBasis::add_loads(const DeformableBody& body, std::span<const Loaded> loaded, const double* w, int stride,
                             int tool) {
  std::vector<const Loaded*> own;
  for (const Loaded& l : loaded)
    if (l.tool == tool) own.push_back(&l);
  if (own.empty()) return;
  std::vector<Vec3> place;
  Vec3 middle = Vec3::Zero();
  for (const Loaded* l : own) middle += place.emplace_back(body.position(l->point)) / double(own.size());
  double size = 0;
  for (Vec3& p : place) size = std::max(size, (p -= middle).norm());
  const long n = long(own.size()), all = size > 0 ? 12 : 3;
  Columns load = Columns::Zero(3 * n, all), compliance(3 * n, 3 * n);
  for (long i = 0; i < n; ++i)
    for (long k = 0; k < 3; ++k) {
      load(3 * i + k, k) = 1;
      for (long a = 0; a < 3 && all > 3; ++a) load(3 * i + k, 3 + 3 * a + k) = place[std::size_t(i)][a] / size;
    }
  for (long i = 0; i < 3 * n; ++i)
    for (long j = 0; j < 3 * n; ++j)
      compliance(i, j) = w[std::size_t(own[std::size_t(i / 3)]->row + i % 3) * std::size_t(stride) +
                           std::size_t(own[std::size_t(j / 3)]->row + j % 3)];
  // Ritz vectors of W among these loads.
  const Columns gram = load.transpose() * load, ritz = load.transpose() * compliance * load;
  const Eigen::SelfAdjointEigenSolver<Columns> size_of(gram);
  std::vector<long> kept;
  for (long k = 0; k < all; ++k)
    if (size_of.eigenvalues()[k] > dependent * size_of.eigenvalues()[all - 1]) kept.push_back(k);
  Columns unit(all, long(kept.size()));
  for (long k = 0; k < unit.cols(); ++k)
    unit.col(k) =
        size_of.eigenvectors().col(kept[std::size_t(k)]) / std::sqrt(size_of.eigenvalues()[kept[std::size_t(k)]]);
  const Eigen::SelfAdjointEigenSolver<Columns> best(Columns(unit.transpose() * ritz * unit));
  const long taken = std::min<long>(size_.loads_of_tool, unit.cols());
  const Columns chosen = load * unit * best.eigenvectors().rightCols(taken);
  for (long k = 0; k < taken && columns_ < x_.cols() / size_.levels; ++k, ++columns_) {
    auto column = ax_.col(columns_);
    column.setZero();
    for (long i = 0; i < n; ++i) {
      const MaterialPoint& p = own[std::size_t(i)]->point;
      for (int q = 0; q < p.count; ++q)
        if (const int b = body.free_of_node()[std::size_t(p.node[std::size_t(q)])]; b >= 0)
          column.segment<3>(3 * b) += p.weight[std::size_t(q)] * chosen.col(k).segment<3>(3 * i);
    }
  }
}

void ReducedBasis::compute(const DeformableBody& body, BodySolver& solver, std::span<const Loaded> loaded,
                           const double* w, int stride) {
  clear();
  const long free = 3 * long(body.system().nodes());
  const double h = body.step_length();
  if (loaded.empty() || free == 0 || !(h > 0)) return;
  const long most = long(ReducedModel::max_modes_of_body) / size_.levels * size_.levels;
  x_.resize(free, most);
  ax_.resize(free, most);
  columns_ = 0;
  for (int tool = 0; tool < 2; ++tool) add_loads(body, loaded, w, stride, tool);
  if (columns_ == 0) return;
  mass_.resize(free);
  for (int i = 0; i < body.nodes(); ++i)
    if (const int b = body.free_of_node()[std::size_t(i)]; b >= 0)
      mass_.segment<3>(3 * b).setConstant(body.node_mass()[std::size_t(i)]);
  const int loads = columns_;
  for (int k = 0; k < loads * size_.levels; ++k) {
    if (k >= loads) ax_.col(k) = mass_.cwiseProduct(x_.col(k - loads));
    x_.col(k) = ax_.col(k);
    solver.solve(x_.col(k).data());
    // Without the part of the earlier ones, and of unit energy.
    const VecX shared = x_.leftCols(k).transpose() * ax_.col(k);
    x_.col(k).noalias() -= x_.leftCols(k) * shared;
    ax_.col(k).noalias() -= ax_.leftCols(k) * shared;
    const double energy = x_.col(k).dot(ax_.col(k));
    const double scale = energy > 0 && std::isfinite(energy) ? 1 / std::sqrt(energy) : 0;
    x_.col(k) *= scale;
    ax_.col(k) *= scale;
  }
  columns_ = loads * size_.levels;
  find_modes(body, h);
  velocity_.resize(free);
  gather(body, body.v(), velocity_);
  momentum_ = mv_.transpose() * velocity_;
}

// Combines the Krylov vectors so that V^T A V = 1 and V^T M V is diagonal.
void ReducedBasis::find_modes(const DeformableBody& body, double h) {
  const auto x = x_.leftCols(columns_), ax = ax_.leftCols(columns_);
  const Columns a = x.transpose() * ax;
  const Eigen::SelfAdjointEigenSolver<Columns> energy(Columns(0.5 * (a + a.transpose())));
  int first = 0;
  while (first < columns_ && !(energy.eigenvalues()[first] > dependent * energy.eigenvalues()[columns_ - 1])) ++first;
  const int n = columns_ - first;
  if (n == 0 || !energy.eigenvalues().allFinite()) return;
  Columns basis = energy.eigenvectors().rightCols(n);
  for (int s = 0; s < n; ++s) basis.col(s) /= std::sqrt(energy.eigenvalues()[first + s]);
  const Columns b = x * basis;
  const Eigen::SelfAdjointEigenSolver<Columns> inertia(Columns(b.transpose() * mass_.asDiagonal() * b));
  v_ = b * inertia.eigenvectors();
  av_ = ax * (basis * inertia.eigenvectors());
  mv_ = mass_.asDiagonal() * v_;
  damping_.assign(std::size_t(n), {});
  modes_.assign(std::size_t(n), {});
  double slowest = 0, fastest = infinite;
  for (int i = 0; i < body.nodes(); ++i) {
    if (body.free_of_node()[std::size_t(i)] < 0) continue;
    slowest = std::max(slowest, body.retardation_time_of_node(i));
    fastest = std::min(fastest, body.retardation_time_of_node(i));
  }
  for (int s = 0; s < n; ++s) {
    Damping& d = damping_[std::size_t(s)];
    for (int i = 0; i < body.nodes(); ++i) {
      const int f = body.free_of_node()[std::size_t(i)];
      if (f < 0) continue;
      const auto moved = v_.col(s).segment<3>(3 * f);
      d.of_mass_s += body.node_damping()[std::size_t(i)] * moved.squaredNorm();
      d.retardation_s += body.retardation_time_of_node(i) * moved.dot(av_.col(s).segment<3>(3 * f));
    }
    d.retardation_s = std::clamp(d.retardation_s, std::max(0.0, fastest), slowest);
    // 1 = m/h^2 + c/h + k with c = alpha + T k.
    ReducedModel::Mode& m = modes_[std::size_t(s)];
    m.mass_s2 = std::clamp(inertia.eigenvalues()[s], 0.0, h * h);
    d.of_mass_s = std::clamp(d.of_mass_s, 0.0, h * (1 - m.mass_s2 / (h * h)));
    const double k = (1 - m.mass_s2 / (h * h) - d.of_mass_s / h) / (1 + d.retardation_s / h);
    m.damping_s = d.of_mass_s + d.retardation_s * k;
  }
}

void ReducedBasis::observe(const DeformableBody& body) {
  if (empty()) return;
  const double h = body.step_length();
  gather(body, body.v(), velocity_);
  const VecX rate = av_.transpose() * velocity_, momentum = mv_.transpose() * velocity_;
  for (std::size_t s = 0; s < modes_.size(); ++s) {
    const Damping& d = damping_[s];
    const double v = rate[long(s)], p = momentum[long(s)];
    // Inertia and damping at the end of the step. V^T K v follows from V^T A v.
    const double elastic = (v - p / (h * h) - d.of_mass_s * v / h) / (1 + d.retardation_s / h);
    modes_[s].velocity = v;
    modes_[s].force = (p - momentum_[long(s)]) / h + d.of_mass_s * v + d.retardation_s * elastic;
  }
  momentum_ = momentum;
}

void ReducedBasis::add(const DeformableBody& body, const BodyRows& rows, std::span<const double> compliance,
                       ConstraintProblem& problem) const {
  ReducedModel& model = problem.reduced;
  const auto first = std::size_t(model.size());
  if (empty() || !model.add_group(modes_, std::size_t(problem.rows))) return;
  for (int i = 0; i < rows.count(); ++i) {
    double* g = model.row(std::size_t(rows.row[std::size_t(i)])) + first;
    for (int e = rows.start[std::size_t(i)]; e < rows.start[std::size_t(i) + 1]; ++e)
      if (const int f = body.free_of_node()[std::size_t(rows.block[std::size_t(e)])]; f >= 0)
        for (std::size_t s = 0; s < modes_.size(); ++s)
          g[s] += rows.coeff[std::size_t(e)].dot(v_.col(long(s)).segment<3>(3 * f));
  }
  model.limit(first, std::size_t(problem.rows), [&](std::size_t i) { return compliance[i]; });
}

}  // namespace insula
