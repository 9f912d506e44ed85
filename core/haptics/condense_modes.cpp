// SPDX-License-Identifier: GPL-3.0-or-later
// Modes of the system between the kept rows.
#include "core/haptics/condense_modes.h"

#include <Eigen/Eigenvalues>
#include <numeric>

#include "core/base/math.h"

namespace insula {
namespace {

constexpr double held = 1e-6;  // of a mode that the eliminated rows do not allow
using RowMajor = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;

}  // namespace

void condense_modes(const EliminatedRows& e, std::size_t kept, ReducedModel& model) {
  const long n = model.size(), rows = long(e.rows), k = long(kept);
  const Eigen::OuterStride<> stride{long(e.width)};
  const Eigen::Map<const RowMajor, 0, Eigen::OuterStride<>> y(e.data + e.kept_at, rows, k, stride),
      z(e.data + e.modes_at, rows, n, stride);
  if (z.isZero(0)) return;
  const RowMajor g = Eigen::Map<const RowMajor>(model.participation.data(), k, n) - y.transpose() * z;
  const MatX s = MatX::Identity(n, n) - z.transpose() * z;
  const Eigen::SelfAdjointEigenSolver<MatX> allowed(s);
  long first = 0;
  while (first < n && !(allowed.eigenvalues()[first] > held)) ++first;
  if (first == n || !allowed.eigenvalues().allFinite()) return model.clear();
  const VecX root = allowed.eigenvalues().tail(n - first).cwiseSqrt();
  const MatX e_kept = allowed.eigenvectors().rightCols(n - first);
  const MatX basis = e_kept * root.cwiseInverse().asDiagonal(), back = e_kept * root.asDiagonal();  // S basis = back

  VecX mass(n), damping(n), velocity(n), force(n);
  for (long i = 0; i < n; ++i) {
    const ReducedModel::Mode& m = model.modes[std::size_t(i)];
    mass[i] = m.mass_s2;
    damping[i] = m.damping_s;
    velocity[i] = m.velocity;
    force[i] = m.force;
  }
  const Eigen::SelfAdjointEigenSolver<MatX> inertia(MatX(back.transpose() * mass.asDiagonal() * back));
  const MatX to_new = basis * inertia.eigenvectors(), in_new = back * inertia.eigenvectors();
  const RowMajor participation = g * to_new;
  const VecX new_velocity = to_new.transpose() * velocity, new_force = in_new.transpose() * force;

  std::vector<long> order(std::size_t(n - first));
  std::iota(order.begin(), order.end(), 0L);
  const VecX size = participation.colwise().squaredNorm();
  std::stable_sort(order.begin(), order.end(), [&](long a, long b) { return size[a] > size[b]; });
  order.resize(std::min(order.size(), ReducedModel::max_modes_of_body));
  std::vector<ReducedModel::Mode> modes;
  for (const long i : order)
    modes.push_back({std::max(0.0, inertia.eigenvalues()[i]), (in_new.col(i).array().square() * damping.array()).sum(),
                     new_velocity[i], new_force[i]});
  model.clear();
  model.add_group(modes, kept);
  for (std::size_t row = 0; row < kept; ++row)
    for (std::size_t i = 0; i < order.size(); ++i) model.row(row)[i] = participation(long(row), order[i]);
}

}  // namespace insula
