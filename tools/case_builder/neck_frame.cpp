// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/case_builder/neck_frame.h"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>

namespace insula::case_builder {

namespace {

using Segment = std::array<EdgePoint, 2>;

/// Segments that hang together by the edges which they share. A plane that cuts a branch too gives a line of its own.
std::vector<std::vector<Segment>> lines_of(const std::vector<Segment>& all) {
  std::map<std::pair<int, int>, std::vector<std::size_t>> at_edge;
  for (std::size_t i = 0; i < all.size(); ++i)
    for (const EdgePoint& p : all[i]) at_edge[std::minmax(p.a, p.b)].push_back(i);
  std::vector<char> taken(all.size());
  std::vector<std::vector<Segment>> out;
  for (std::size_t first = 0; first < all.size(); ++first) {
    if (taken[first]) continue;
    std::vector<std::size_t> line{first};
    taken[first] = 1;
    for (std::size_t k = 0; k < line.size(); ++k)
      for (const EdgePoint& p : all[line[k]])
        for (const std::size_t next : at_edge.at(std::minmax(p.a, p.b)))
          if (!taken[next]) taken[next] = 1, line.push_back(next);
    out.emplace_back();
    for (const std::size_t i : line) out.back().push_back(all[i]);
  }
  return out;
}

Vec3 middle_of(const std::vector<Segment>& line, const std::vector<Vec3>& vertices) {
  Vec3 sum = Vec3::Zero();
  double length = 0;
  for (const auto& [a, b] : line) {
    const Vec3 p = a.in(vertices), q = b.in(vertices);
    sum += 0.5 * (q - p).norm() * (p + q), length += (q - p).norm();
  }
  return length > 0 ? Vec3(sum / length) : Vec3(sum);
}

}  // namespace

std::vector<std::array<EdgePoint, 2>> neck_line(const artery::Vessel& v) {
  const artery::Neck& neck = *v.neck;
  const std::vector<Vec3>& x = v.wall.mesh.vertices;
  const auto height = [&](int i) { return (x[std::size_t(i)] - neck.centre).dot(neck.normal); };
  std::vector<Segment> cut;
  for (const auto& t : v.wall.mesh.triangles) {
    std::vector<EdgePoint> ends;
    for (std::size_t k = 0; k < 3; ++k) {
      const int a = t[k], b = t[(k + 1) % 3];
      const double at_a = height(a), at_b = height(b);
      if ((at_a > 0) != (at_b > 0)) ends.push_back({a, b, at_a / (at_a - at_b)});
    }
    if (ends.size() == 2) cut.push_back({ends[0], ends[1]});
  }
  std::vector<std::vector<Segment>> lines = lines_of(cut);
  const auto nearest = std::min_element(lines.begin(), lines.end(), [&](const auto& a, const auto& b) {
    return (middle_of(a, x) - neck.centre).norm() < (middle_of(b, x) - neck.centre).norm();
  });
  return nearest == lines.end() ? std::vector<Segment>{} : *nearest;
}

artery::Neck deformed_neck(const artery::Vessel& at_rest, const std::vector<Vec3>& vertices) {
  const auto line = neck_line(at_rest);
  if (line.empty()) return *at_rest.neck;
  const Vec3 centre = middle_of(line, vertices);
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
