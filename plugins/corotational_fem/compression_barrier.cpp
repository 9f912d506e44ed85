// SPDX-License-Identifier: GPL-3.0-or-later
// Energy sum of f(s_i) over the principal stretches, F = U diag(s) V^T with U = R Q, V = Q, S = Q diag(s) Q^T. In that
// basis the Hessian is diagonal: stretches f'', shears (f'_i - f'_j)/(s_i - s_j), spins (f'_i + f'_j)/(s_i + s_j)
// (Smith, de Goes, Kim 2019, "Analytic eigensystems for isotropic distortion energies").
#include "plugins/corotational_fem/compression_barrier.h"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>

namespace insula {
namespace {

Mat3 stretch_of_lane(const ElementWork& work, int l) {
  Mat3 s;
  s << work.s[0][l], work.s[3][l], work.s[4][l], work.s[3][l], work.s[1][l], work.s[5][l], work.s[4][l], work.s[5][l],
      work.s[2][l];
  return s;
}

}  // namespace

void stiffen(const ElementBatch& e, const ElementWork& work, int l, const BarrierLaw& law, double* force,
             BlockMatrix* stiffness, double scale, bool positive) {
  Eigen::SelfAdjointEigenSolver<Mat3> eigen;
  eigen.computeDirect(stretch_of_lane(work, l));
  const Vec3 stretch = eigen.eigenvalues();
  if (stretch[0] >= law.barrier_stretch) return;
  const Mat3 v = eigen.eigenvectors(), u = matrix_of_lane(work.r, l) * v;
  Vec3 slope, curve;
  for (int i = 0; i < 3; ++i) {
    slope[i] = std::min(0.0, law.stiffness * (stretch[i] - law.barrier_stretch));
    curve[i] = slope[i] < 0 ? law.stiffness : 0;
  }
  Vec3 b[4];  // rest gradients in the principal frame
  for (int n = 0; n < 4; ++n) {
    b[n] = v.transpose() * rest_gradient(e, l, n);
    Eigen::Map<Vec3> f(force + 3 * e.node[n][l]);
    f -= e.volume[l] * (u * slope.cwiseProduct(b[n]));
  }
  if (!stiffness) return;
  double shear[3][3], spin[3][3];
  for (int i = 0; i < 3; ++i)
    for (int j = 0; j < i; ++j) {
      const double apart = stretch[i] - stretch[j], sum = stretch[i] + stretch[j];
      shear[i][j] = std::abs(apart) > 1e-9 ? (slope[i] - slope[j]) / apart : 0.5 * (curve[i] + curve[j]);
      spin[i][j] = std::abs(sum) > 1e-9 ? (slope[i] + slope[j]) / sum : 0;
      if (positive) spin[i][j] = std::max(0.0, spin[i][j]);
      shear[j][i] = shear[i][j];
      spin[j][i] = spin[i][j];
    }
  for (int n = 0, slot = 0; n < 4; ++n)
    for (int m = 0; m <= n; ++m, ++slot) {
      if (e.slot[slot][l] < 0) continue;
      const Vec3 &row = b[n], &column = b[m];
      Mat3 h;
      for (int i = 0; i < 3; ++i) {
        h(i, i) = curve[i] * row[i] * column[i];
        for (int j = 0; j < 3; ++j) {
          if (i == j) continue;
          h(i, i) += 0.5 * (shear[i][j] + spin[i][j]) * row[j] * column[j];
          h(i, j) = 0.5 * (shear[i][j] - spin[i][j]) * row[j] * column[i];
        }
      }
      Eigen::Map<Mat3>(stiffness->block(e.slot[slot][l])) += scale * e.volume[l] * (u * h * u.transpose());
    }
}

double barrier_energy(const ElementBatch& e, const ElementWork& work, int l, const BarrierLaw& law) {
  Eigen::SelfAdjointEigenSolver<Mat3> eigen;
  eigen.computeDirect(stretch_of_lane(work, l), Eigen::EigenvaluesOnly);
  double sum = 0;
  for (int i = 0; i < 3; ++i) {
    const double short_of = std::max(0.0, law.barrier_stretch - eigen.eigenvalues()[i]);
    sum += 0.5 * e.volume[l] * law.stiffness * short_of * short_of;
  }
  return sum;
}

}  // namespace insula
