// SPDX-License-Identifier: GPL-3.0-or-later
// Rest state and coupling of the bending patches.
#include "plugins/membrane/bend.h"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>

namespace insula {
namespace {

constexpr double collapsed = 0.1;  ///< share of the rest area below which the angle's gradient is bounded
constexpr int held = -1;

/// Square root of the bending stiffness on (k11, k22, 2 k12) with the directions `free` (columns) given up to no
/// moment.
Mat3 root_of_stiffness(const StretchTriangles::Material& m, const Eigen::Matrix<double, 3, Eigen::Dynamic>& free) {
  const double d = m.young * m.thickness * m.thickness * m.thickness / (12 * (1 - m.poisson * m.poisson));
  Mat3 k;
  k << 1, m.poisson, 0, m.poisson, 1, 0, 0, 0, 0.5 * (1 - m.poisson);
  if (free.cols() > 0) {
    const MatX kf = k * free;
    k -= kf * (free.transpose() * kf).completeOrthogonalDecomposition().pseudoInverse() * kf.transpose();
  }
  const Eigen::SelfAdjointEigenSolver<Mat3> eigen(k);
  // Rounding errors of the elimination do not count as stiffness.
  const Vec3 root = eigen.eigenvalues().unaryExpr([](double v) { return v > 1e-12 ? std::sqrt(v) : 0.0; });
  return std::sqrt(d) * (root.asDiagonal() * eigen.eigenvectors().transpose());
}

}  // namespace

void BendPatches::build(const WallTopology& wall, const std::vector<Vec3>& rest,
                        const std::vector<const StretchTriangles::Material*>& material) {
  std::vector<SlopeWeights> slopes(wall.hinges.size());
  std::vector<int> number(wall.hinges.size(), -1);  // of the hinges that patches here use
  hinges_.clear();
  patches_.clear();
  for (std::size_t t = 0; t < wall.triangles.size(); ++t) {
    if (!material[t]) continue;
    const auto& v = wall.triangles[t];
    const Vec3 x0 = rest[std::size_t(v[0])], e1 = (rest[std::size_t(v[1])] - x0).normalized();
    const Vec3 doubled = (rest[std::size_t(v[1])] - x0).cross(rest[std::size_t(v[2])] - x0),
               e2 = doubled.normalized().cross(e1);
    const double area = 0.5 * doubled.norm();
    Patch p;
    double curvature[max_hinges][3] = {};
    Eigen::Matrix<double, 3, Eigen::Dynamic> free(3, 0);
    for (int k = 0; k < 3; ++k) {
      const Vec3 along = rest[std::size_t(v[std::size_t((k + 1) % 3)])] - rest[std::size_t(v[std::size_t(k)])];
      const double length = along.norm(), nx = along.dot(e2) / length, ny = -along.dot(e1) / length;
      const Vec3 bend = length / area * Vec3(nx * nx, ny * ny, 2 * nx * ny);
      const int h = wall.hinge_of[t][std::size_t(k)];
      if (h < 0) {
        free.conservativeResize(3, free.cols() + 1);
        free.col(free.cols() - 1) = bend;
        continue;
      }
      SlopeWeights& s = slopes[std::size_t(h)];
      if (s.count == 0) s = slope_weights(wall, rest, h);
      const bool first = wall.sides[std::size_t(h)][0].triangle == int(t);
      for (int i = 0; i < s.count; ++i) {
        const double weight = first ? s.weight[i] : (i == 0 ? 1 - s.weight[i] : -s.weight[i]);
        int& local = number[std::size_t(s.hinge[i])];
        if (local < 0) {
          local = int(hinges_.size());
          hinges_.push_back(wall.hinges[std::size_t(s.hinge[i])]);
        }
        int at = 0;
        while (at < p.hinges && p.hinge[at] != local) ++at;
        if (at == p.hinges) p.hinge[p.hinges++] = local;
        for (int c = 0; c < 3; ++c) curvature[at][c] += weight * bend[c];
      }
    }
    const Mat3 root = std::sqrt(area) * root_of_stiffness(*material[t], free);
    for (int i = 0; i < p.hinges; ++i) {
      Eigen::Map<Vec3>(p.c[i]) = root * Vec3(curvature[i][0], curvature[i][1], curvature[i][2]);
      for (int n : hinges_[std::size_t(p.hinge[i])].node)
        if (std::find(p.node, p.node + p.nodes, n) == p.node + p.nodes) p.node[p.nodes++] = n;
    }
    if (p.hinges > 0) patches_.push_back(p);
  }
  constexpr double share = 0.6;  // of Gershgorin's bound
  step_stiffness_.assign(hinges_.size(), 0.0);
  for (const Patch& p : patches_)
    for (int i = 0; i < p.hinges; ++i)
      for (int j = 0; j < p.hinges; ++j)
        step_stiffness_[std::size_t(p.hinge[i])] +=
            share * std::abs(Eigen::Map<const Vec3>(p.c[i]).dot(Eigen::Map<const Vec3>(p.c[j])));
  for (WallHinge& hinge : hinges_)
    for (int s = 0; s < 2; ++s) {
      const auto at = [&](int k) -> const Vec3& { return rest[std::size_t(hinge.node[k])]; };
      hinge.least[s] = collapsed * collapsed * (at(1) - at(0)).cross(at(2 + s) - at(0)).squaredNorm();
    }
  batches_.clear();
  for (std::size_t first = 0; first < hinges_.size(); first += wall_lanes) {
    HingeBatch& b = batches_.emplace_back();
    b.count = int(std::min(hinges_.size() - first, std::size_t(wall_lanes)));
    for (int l = 0; l < wall_lanes; ++l) {
      const WallHinge& hinge = hinges_[first + std::size_t(std::min(l, b.count - 1))];
      for (int k = 0; k < 4; ++k) b.node[k][l] = hinge.node[k];
      for (int s = 0; s < 2; ++s) b.least[s][l] = hinge.least[s];
    }
  }
  rest_angle_.assign(hinges_.size(), 0.0);
  if (!rest.empty()) find_angles(rest.front().data(), rest_angle_, nullptr);
  start_angle_ = energy_angle_ = rest_angle_;
  moment_.assign(hinges_.size(), 0.0);
  gradient_.assign(16 * hinges_.size(), 0.0);  // each node's three padded to four
  reset();
}

void BendPatches::couplings(std::vector<std::pair<int, int>>& pairs, Tangent which, bool patches) const {
  if (which == Tangent::system && !patches) {
    for (const WallHinge& h : hinges_)
      for (int i = 0; i < 4; ++i)
        for (int j = 0; j < i; ++j) pairs.emplace_back(h.node[i], h.node[j]);
    return;
  }
  for (const Patch& p : patches_)
    for (int i = 0; i < p.nodes; ++i)
      for (int j = 0; j < i; ++j) pairs.emplace_back(p.node[i], p.node[j]);
}

void BendPatches::bind(const BlockMatrix& a, const std::vector<int>& free_of_node) {
  const auto block = [&](int node) { return free_of_node[std::size_t(node)]; };
  slots_.clear();
  for (Patch& p : patches_) {
    std::sort(p.node, p.node + p.nodes,
              [&](int i, int j) { return block(i) != block(j) ? block(i) < block(j) : i < j; });
    for (int h = 0; h < p.hinges; ++h)
      for (int k = 0; k < 4; ++k)
        p.local[h][k] = static_cast<unsigned char>(
            std::find(p.node, p.node + p.nodes, hinges_[std::size_t(p.hinge[h])].node[k]) - p.node);
    p.first_slot = int(slots_.size());
    for (int i = 0; i < p.nodes; ++i)
      // The step's matrix has no such blocks unless its tangent is made of patches.
      for (int j = 0; j <= i; ++j)
        slots_.push_back(
            block(p.node[i]) < 0 || block(p.node[j]) < 0 ? held : a.find_slot(block(p.node[i]), block(p.node[j])));
  }
  hinge_slot_.resize(hinges_.size());
  for (std::size_t h = 0; h < hinges_.size(); ++h)
    for (int i = 0, k = 0; i < 4; ++i)
      for (int j = 0; j <= i; ++j, ++k) {
        const int fi = block(hinges_[h].node[i]), fj = block(hinges_[h].node[j]);
        hinge_slot_[h][std::size_t(k)] = fi < 0 || fj < 0 ? no_slot
                                         : fi >= fj       ? a.find_slot(fi, fj)
                                                          : ~a.find_slot(fj, fi);
      }
}

}  // namespace insula
