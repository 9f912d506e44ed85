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

// Builds the patches of the wall's triangles, and lists the hinges that they use.
class BendPatches::Maker {
 public:
  Maker(BendPatches& to, const WallTopology& wall, const std::vector<Vec3>& rest)
      : to_(to), wall_(wall), rest_(rest), slopes_(wall.hinges.size()), number_(wall.hinges.size(), -1) {}

  void add(std::size_t t, const StretchTriangles::Material& material) {
    const auto& v = wall_.triangles[t];
    const Vec3 x0 = rest_[std::size_t(v[0])], e1 = (rest_[std::size_t(v[1])] - x0).normalized();
    const Vec3 doubled = (rest_[std::size_t(v[1])] - x0).cross(rest_[std::size_t(v[2])] - x0),
               e2 = doubled.normalized().cross(e1);
    const double area = 0.5 * doubled.norm();
    Patch p;
    double curvature[max_hinges][3] = {};
    Eigen::Matrix<double, 3, Eigen::Dynamic> free(3, 0);
    for (int k = 0; k < 3; ++k) {
      const Vec3 along = rest_[std::size_t(v[std::size_t((k + 1) % 3)])] - rest_[std::size_t(v[std::size_t(k)])];
      const double length = along.norm(), nx = along.dot(e2) / length, ny = -along.dot(e1) / length;
      const Vec3 bend = length / area * Vec3(nx * nx, ny * ny, 2 * nx * ny);
      const int h = wall_.hinge_of[t][std::size_t(k)];
      if (h < 0) {
        free.conservativeResize(3, free.cols() + 1);
        free.col(free.cols() - 1) = bend;
      } else {
        add_slope(p, curvature, h, wall_.sides[std::size_t(h)][0].triangle == int(t), bend);
      }
    }
    set_coupling(p, curvature, std::sqrt(area) * root_of_stiffness(material, free));
    if (p.hinges > 0) to_.patches_.push_back(p);
  }

 private:
  /// Adds the contribution of the slope across hinge h to the curvature of a patch on its first or second side.
  void add_slope(Patch& p, double (*curvature)[3], int h, bool first, const Vec3& bend) {
    SlopeWeights& s = slopes_[std::size_t(h)];
    if (s.count == 0) s = slope_weights(wall_, rest_, h);
    for (int i = 0; i < s.count; ++i) {
      const double weight = first ? s.weight[i] : (i == 0 ? 1 - s.weight[i] : -s.weight[i]);
      const int local = local_hinge(s.hinge[i]);
      int at = 0;
      while (at < p.hinges && p.hinge[at] != local) ++at;
      if (at == p.hinges) p.hinge[p.hinges++] = local;
      for (int c = 0; c < 3; ++c) curvature[at][c] += weight * bend[c];
    }
  }

  int local_hinge(int of_wall) {
    int& local = number_[std::size_t(of_wall)];
    if (local < 0) {
      local = int(to_.hinges_.size());
      to_.hinges_.push_back(wall_.hinges[std::size_t(of_wall)]);
    }
    return local;
  }

  void set_coupling(Patch& p, const double (*curvature)[3], const Mat3& root) const {
    for (int i = 0; i < p.hinges; ++i) {
      Eigen::Map<Vec3>(p.c[i]) = root * Vec3(curvature[i][0], curvature[i][1], curvature[i][2]);
      for (int n : to_.hinges_[std::size_t(p.hinge[i])].node)
        if (std::find(p.node, p.node + p.nodes, n) == p.node + p.nodes) p.node[p.nodes++] = n;
    }
  }

  BendPatches& to_;
  const WallTopology& wall_;
  const std::vector<Vec3>& rest_;
  std::vector<SlopeWeights> slopes_;
  std::vector<int> number_;  ///< index in hinges_ of each hinge of the wall, -1: not used
};

void BendPatches::find_step_stiffness() {
  constexpr double share = 0.6;  // of Gershgorin's bound
  step_stiffness_.assign(hinges_.size(), 0.0);
  for (const Patch& p : patches_)
    for (int i = 0; i < p.hinges; ++i)
      for (int j = 0; j < p.hinges; ++j)
        step_stiffness_[std::size_t(p.hinge[i])] +=
            share * std::abs(Eigen::Map<const Vec3>(p.c[i]).dot(Eigen::Map<const Vec3>(p.c[j])));
}

void BendPatches::make_batches(const std::vector<Vec3>& rest) {
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
}

void BendPatches::build(const WallTopology& wall, const std::vector<Vec3>& rest,
                        const std::vector<const StretchTriangles::Material*>& material) {
  hinges_.clear();
  patches_.clear();
  Maker maker(*this, wall, rest);
  for (std::size_t t = 0; t < wall.triangles.size(); ++t)
    if (material[t]) maker.add(t, *material[t]);
  find_step_stiffness();
  make_batches(rest);
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
