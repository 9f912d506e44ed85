// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/case_builder/neck_frame.h"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <numbers>

namespace insula::case_builder {

std::vector<std::array<EdgePoint, 2>> neck_line(const artery::Vessel& v) {
  const artery::Neck& neck = *v.neck;
  const auto index = [&](const char* name) {
    return int(std::find(v.regions.begin(), v.regions.end(), name) - v.regions.begin());
  };
  const int of_neck = index("neck"), of_sac = index("sac");
  const auto belongs = [&](int i) { return v.region[std::size_t(i)] == of_neck || v.region[std::size_t(i)] == of_sac; };
  const auto height = [&](int i) { return (v.wall.mesh.vertices[std::size_t(i)] - neck.centre).dot(neck.normal); };
  std::vector<std::array<EdgePoint, 2>> out;
  for (const auto& t : v.wall.mesh.triangles) {
    if (!belongs(t[0]) && !belongs(t[1]) && !belongs(t[2])) continue;
    std::vector<EdgePoint> ends;
    for (std::size_t k = 0; k < 3; ++k) {
      const int a = t[k], b = t[(k + 1) % 3];
      const double at_a = height(a), at_b = height(b);
      if ((at_a > 0) != (at_b > 0)) ends.push_back({a, b, at_a / (at_a - at_b)});
    }
    if (ends.size() == 2) out.push_back({ends[0], ends[1]});
  }
  return out;
}

artery::Neck deformed_neck(const artery::Vessel& at_rest, const std::vector<Vec3>& vertices) {
  const auto line = neck_line(at_rest);
  Vec3 centre = Vec3::Zero();
  double length = 0;
  for (const auto& [a, b] : line) {
    const Vec3 p = a.in(vertices), q = b.in(vertices);
    centre += 0.5 * (q - p).norm() * (p + q), length += (q - p).norm();
  }
  if (!(length > 0)) return *at_rest.neck;
  centre /= length;
  Mat3 spread = Mat3::Zero();
  double area = 0;
  for (const auto& [a, b] : line) {
    const Vec3 p = a.in(vertices)-centre, q = b.in(vertices)-centre;
    spread += (q - p).norm() * 0.5 * (p * p.transpose() + q * q.transpose());
    area += 0.5 * p.cross(q).norm();
  }
  Vec3 normal = Eigen::SelfAdjointEigenSolver<Mat3>(spread).eigenvectors().col(0);
  if (normal.dot(at_rest.neck->normal) < 0) normal = -normal;
  return {centre, normal, 2 * std::sqrt(area / std::numbers::pi)};
}

}  // namespace insula::case_builder
