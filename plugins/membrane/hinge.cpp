// SPDX-License-Identifier: GPL-3.0-or-later
// Angle of two triangles about their common edge.
#include "plugins/membrane/hinge.h"

#include <algorithm>

#include "plugins/membrane/hinge_formula.h"

namespace insula {
namespace {

HingeShape<double> shape_of(const double* x, const WallHinge& h) {
  double at[12];
  for (int k = 0; k < 4; ++k)
    for (int c = 0; c < 3; ++c) at[3 * k + c] = x[3 * h.node[k] + c];
  return hinge_shape(at, h.least[0], h.least[1]);
}

}  // namespace

double hinge_angle(const double* x, const WallHinge& h, double* gradient) {
  const HingeShape<double> s = shape_of(x, h);
  if (gradient) {
    double g[12];
    gradient_of(s, g);
    std::copy(g, g + 12, gradient);
  }
  return angle_of(s);
}

Mat12 hinge_hessian(const double* x, const WallHinge& h) {
  const HingeShape<double> s = shape_of(x, h);
  const auto vector = [](const double* v) { return Eigen::Map<const Vec3>(v); };
  const auto e = vector(s.e), a = vector(s.a), b = vector(s.b), n1 = vector(s.n1), n2 = vector(s.n2);
  const double length = std::sqrt(s.e2);
  const auto of_apex = [&](const Vec3& n, double size, const Vec3& apex, double sign, Vec3& g, Mat3& by_edge,
                           Mat3& by_apex) {
    g = (length / size) * n;
    const Mat3 m = (length / size) * (Mat3::Identity() - (2 / size) * n * n.transpose());
    by_apex = sign * m * skew(e);
    by_edge = -sign * m * skew(apex) + n * e.transpose() / (length * size);
  };
  Vec3 ga, gb;
  Mat3 ae, aa, be, bb;  // derivatives of ga, gb by the edge and by their apex
  of_apex(n1, s.size1, a, 1, ga, ae, aa);
  of_apex(n2, s.size2, b, -1, gb, be, bb);
  const Vec3 da = a / s.e2 - (2 * s.along1 / s.e2) * e, db = b / s.e2 - (2 * s.along2 / s.e2) * e;
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

}  // namespace insula
