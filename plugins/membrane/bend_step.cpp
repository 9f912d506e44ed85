// SPDX-License-Identifier: GPL-3.0-or-later
// Force, tangent and energy of the bending patches.
#include <algorithm>
#include <cmath>
#include <cstring>

#include "plugins/membrane/bend.h"

namespace insula {

using FourAnywhere = double __attribute__((vector_size(32), aligned(8), may_alias));

// Angles nearest to the values in `angle`.
void BendPatches::find_angles(const double* x, std::vector<double>& angle, double* gradient) const {
  const WallKernels& kernels = wall_kernels();
  for (std::size_t i = 0; i < batches_.size(); ++i)
    kernels.hinges(batches_[i], x, angle.data() + wall_lanes * i, gradient ? gradient + 16 * wall_lanes * i : nullptr);
}

void BendPatches::residual(const Patch& p, const std::vector<double>& angle, double r[3]) const {
  r[0] = r[1] = r[2] = 0;
  for (int i = 0; i < p.hinges; ++i) {
    const std::size_t h = std::size_t(p.hinge[i]);
    const double turned = angle[h] - rest_angle_[h];
    for (int c = 0; c < 3; ++c) r[c] += p.c[i][c] * turned;
  }
}

void BendPatches::linearise(const double* x, double* force, BlockMatrix* stiffness, double scale, Tangent which,
                            bool patches) {
  patches = patches || which == Tangent::exact;
  find_angles(x, angle_, gradient_.data());
  std::fill(moment_.begin(), moment_.end(), 0.0);
  const double root = std::sqrt(scale);
  for (const Patch& p : patches_) {
    double r[3];
    residual(p, angle_, r);
    for (int i = 0; i < p.hinges; ++i)
      moment_[std::size_t(p.hinge[i])] += p.c[i][0] * r[0] + p.c[i][1] * r[1] + p.c[i][2] * r[2];
    if (stiffness && patches) assemble(p, root, *stiffness);
  }
  for (std::size_t h = 0; h < hinges_.size(); ++h)
    for (int k = 0; k < 4; ++k) {
      double* f = force + 3 * hinges_[h].node[k];
      const double* g = gradient_.data() + 16 * h + 4 * std::size_t(k);
      for (int c = 0; c < 3; ++c) f[c] -= moment_[h] * g[c];
    }
  if (stiffness && !patches) add_hinges(*stiffness, scale);
  if (stiffness && which == Tangent::exact) add_curvature_of_hinges(x, *stiffness, scale);
}

// K = B^T B with B = sum c_h grad(angle_h)^T, 3 rows: the positive semidefinite part of the second derivative.
void BendPatches::assemble(const Patch& p, double root, BlockMatrix& stiffness) {
  std::memset(rows_.row, 0, sizeof rows_.row);
  for (int i = 0; i < p.hinges; ++i) {
    const auto* g = reinterpret_cast<const FourAnywhere*>(gradient_.data() + 16 * std::size_t(p.hinge[i]));
    const double c0 = root * p.c[i][0], c1 = root * p.c[i][1], c2 = root * p.c[i][2];
    for (int k = 0; k < 4; ++k) {
      auto* row = reinterpret_cast<FourAnywhere*>(rows_.row[p.local[i][k]][0]);
      row[0] += c0 * g[k];
      row[1] += c1 * g[k];
      row[2] += c2 * g[k];
    }
  }
  add_patch(rows_, p.nodes, slots_.data() + p.first_slot, stiffness.block(0));
}

void BendPatches::add_hinges(BlockMatrix& stiffness, double scale) const {
  for (std::size_t h = 0; h < hinges_.size(); ++h) {
    const double* g = gradient_.data() + 16 * h;
    const double k = scale * step_stiffness_[h];
    for (int i = 0, s = 0; i < 4; ++i)
      for (int j = 0; j <= i; ++j, ++s) {
        const int slot = hinge_slot_[h][std::size_t(s)];
        if (slot == no_slot) continue;
        const double* row = g + 4 * (slot < 0 ? j : i);
        const double* column = g + 4 * (slot < 0 ? i : j);
        double* block = stiffness.block(slot < 0 ? ~slot : slot);
        for (int c = 0; c < 3; ++c)
          for (int r = 0; r < 3; ++r) block[3 * c + r] += k * row[r] * column[c];
      }
  }
}

void BendPatches::add_curvature_of_hinges(const double* x, BlockMatrix& stiffness, double scale) const {
  for (std::size_t h = 0; h < hinges_.size(); ++h) {
    const Mat12 k = scale * moment_[h] * hinge_hessian(x, hinges_[h]);
    for (int i = 0, s = 0; i < 4; ++i)
      for (int j = 0; j <= i; ++j, ++s) {
        int slot = hinge_slot_[h][std::size_t(s)];
        if (slot == no_slot) continue;
        Mat3 part = k.block<3, 3>(3 * i, 3 * j);
        if (slot < 0) {
          slot = ~slot;
          part.transposeInPlace();
        }
        Eigen::Map<Mat3>(stiffness.block(slot)) += part;
      }
  }
}

void BendPatches::prestrain(const double* rest, const double* u) {
  for (std::size_t h = 0; h < hinges_.size(); ++h) {
    double g[12];
    hinge_angle(rest, hinges_[h], g);
    for (int k = 0; k < 4; ++k)
      for (int c = 0; c < 3; ++c) rest_angle_[h] += g[3 * k + c] * u[3 * hinges_[h].node[k] + c];
  }
}

double BendPatches::energy(const double* x) {
  std::vector<double>& angle = energy_angle_;
  angle = angle_;
  find_angles(x, angle, nullptr);
  double sum = 0;
  for (const Patch& p : patches_) {
    double r[3];
    residual(p, angle, r);
    sum += 0.5 * (r[0] * r[0] + r[1] * r[1] + r[2] * r[2]);
  }
  return sum;
}

}  // namespace insula
