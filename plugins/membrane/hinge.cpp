// SPDX-License-Identifier: GPL-3.0-or-later
// Angle of two triangles about their common edge.
#include "plugins/membrane/hinge.h"

#include <cmath>
#include <numbers>

namespace insula {
namespace {

struct Shape {
  Vec3 e, a, b;    // edge, apexes from the edge's first end
  Vec3 n1, n2;     // doubled area vectors
  double e2, size1, size2, along1, along2;
  Shape(const double* x, const WallHinge& h) {
    const auto at = [&](int k) { return Eigen::Map<const Vec3>(x + 3 * h.node[k]); };
    e = at(1) - at(0);
    a = at(2) - at(0);
    b = at(3) - at(0);
    n1 = e.cross(a);
    n2 = b.cross(e);
    e2 = std::max(e.squaredNorm(), 1e-300);
    size1 = std::max({n1.squaredNorm(), h.least[0], 1e-300});
    size2 = std::max({n2.squaredNorm(), h.least[1], 1e-300});
    along1 = e.dot(a) / e2;
    along2 = e.dot(b) / e2;
  }
};

}  // namespace

double hinge_angle(const double* x, const WallHinge& h, double* gradient) {
  const Shape s(x, h);
  const double length = std::sqrt(s.e2);
  if (gradient) {
    const Vec3 a = (length / s.size1) * s.n1, b = (length / s.size2) * s.n2;
    Eigen::Map<Vec3> g0(gradient), g1(gradient + 3), g2(gradient + 6), g3(gradient + 9);
    g1 = -s.along1 * a - s.along2 * b;
    g0 = -(a + b + g1);
    g2 = a;
    g3 = b;
  }
  return std::atan2(s.e.dot(s.n2.cross(s.n1)) / length, s.n1.dot(s.n2));
}

Mat12 hinge_hessian(const double* x, const WallHinge& h) {
  const Shape s(x, h);
  const double length = std::sqrt(s.e2);
  const auto of_apex = [&](const Vec3& n, double size, const Vec3& apex, double sign, Vec3& g, Mat3& by_edge, Mat3& by_apex) {
    g = (length / size) * n;
    const Mat3 m = (length / size) * (Mat3::Identity() - (2 / size) * n * n.transpose());
    by_apex = sign * m * skew(s.e);
    by_edge = -sign * m * skew(apex) + n * s.e.transpose() / (length * size);
  };
  Vec3 ga, gb;
  Mat3 ae, aa, be, bb;  // derivatives of ga, gb by the edge and by their apex
  of_apex(s.n1, s.size1, s.a, 1, ga, ae, aa);
  of_apex(s.n2, s.size2, s.b, -1, gb, be, bb);
  const Vec3 da = s.a / s.e2 - (2 * s.along1 / s.e2) * s.e, db = s.b / s.e2 - (2 * s.along2 / s.e2) * s.e;
  const Mat3 ee = -ga * da.transpose() - s.along1 * ae - gb * db.transpose() - s.along2 * be;
  Eigen::Matrix<double, 9, 9> k = Eigen::Matrix<double, 9, 9>::Zero();  // by edge, first apex, second apex
  k.block<3, 3>(0, 0) = ee;
  k.block<3, 3>(3, 0) = ae;
  k.block<3, 3>(0, 3) = ae.transpose();
  k.block<3, 3>(3, 3) = aa;
  k.block<3, 3>(6, 0) = be;
  k.block<3, 3>(0, 6) = be.transpose();
  k.block<3, 3>(6, 6) = bb;
  Eigen::Matrix<double, 9, 12> map = Eigen::Matrix<double, 9, 12>::Zero();
  for (int i = 0; i < 9; ++i) {
    map(i, i % 3) = -1;
    map(i, 3 + i) = 1;
  }
  return map.transpose() * k * map;
}

double unwrapped(double angle, double before) {
  constexpr double turn = 2 * std::numbers::pi;
  return angle + turn * std::nearbyint((before - angle) / turn);
}

}  // namespace insula
