// SPDX-License-Identifier: GPL-3.0-or-later
// Star-mesh elimination.
#include "plugins/pressure/star_mesh.h"

namespace insula {

void StarMesh::clear(int n) {
  n_ = n;
  g_.assign(std::size_t(n) * std::size_t(n), 0.0);
  ground_.assign(std::size_t(n), 0.0);
  current_.assign(std::size_t(n), 0.0);
  pivot_.assign(std::size_t(n), 0.0);
}

void StarMesh::link(int i, int j, double g) {
  if (i == j) return;
  g_[std::size_t(i * n_ + j)] += g;
  g_[std::size_t(j * n_ + i)] += g;
}

void StarMesh::ground(int i, double g, double p) {
  ground_[std::size_t(i)] += g;
  current_[std::size_t(i)] += g * p;
}

void StarMesh::eliminate(int k) {
  const double* row = g_.data() + std::size_t(k * n_);
  double sum = ground(k);
  for (int j = k + 1; j < n_; ++j) sum += row[j];
  pivot_[std::size_t(k)] = sum;
  if (!(sum > 0)) return;
  for (int i = k + 1; i < n_; ++i) {
    if (row[i] == 0) continue;
    const double share = row[i] / sum;
    for (int j = k + 1; j < n_; ++j)
      if (j != i) g_[std::size_t(i * n_ + j)] += share * row[j];
    ground_[std::size_t(i)] += share * ground(k);
    current_[std::size_t(i)] += share * current(k);
  }
}

double StarMesh::pressure(int k, const double* p, double floating) const {
  if (!(pivot(k) > 0)) return floating;
  double sum = current(k);
  for (int j = k + 1; j < n_; ++j) sum += link(k, j) * p[j];
  return sum / pivot(k);
}

}  // namespace insula
