// SPDX-License-Identifier: GPL-3.0-or-later
// Smooth curves with a radius.
#include "curve.h"

#include <algorithm>
#include <cmath>

namespace insula::artery {
namespace {

std::vector<double> arc_lengths(const std::vector<Vec3>& p) {
  std::vector<double> s(p.size(), 0.0);
  for (std::size_t i = 1; i < p.size(); ++i) s[i] = s[i - 1] + (p[i] - p[i - 1]).norm();
  return s;
}

/// Second derivatives of the natural cubic spline (Thomas algorithm).
std::vector<Vec3> natural_spline(const std::vector<double>& t, const std::vector<Vec3>& p) {
  const std::size_t n = p.size();
  std::vector<Vec3> m(n, Vec3::Zero()), right(n, Vec3::Zero());
  std::vector<double> upper(n, 0.0);
  for (std::size_t i = 1; i + 1 < n; ++i) {
    const double a = t[i] - t[i - 1], b = t[i + 1] - t[i];
    const double diagonal = 2 * (a + b) - a * upper[i - 1];
    upper[i] = b / diagonal;
    right[i] = (6 * ((p[i + 1] - p[i]) / b - (p[i] - p[i - 1]) / a) - a * right[i - 1]) / diagonal;
  }
  for (std::size_t i = n - 1; i-- > 1;) m[i] = right[i] - upper[i] * m[i + 1];
  return m;
}

}  // namespace

double Curve::length() const { return points.empty() ? 0 : arc_lengths(points).back(); }

Vec3 Curve::tangent(std::size_t i) const {
  const std::size_t a = i > 0 ? i - 1 : 0, b = std::min(i + 1, points.size() - 1);
  return (points[b] - points[a]).normalized();
}

Curve smooth_curve(const std::vector<Vec3>& through, double first_radius, double last_radius, double step) {
  const std::vector<double> t = arc_lengths(through);
  const std::vector<Vec3> m = natural_spline(t, through);
  Curve fine;
  for (std::size_t i = 0; i + 1 < through.size(); ++i) {
    const double h = t[i + 1] - t[i];
    const int parts = std::max(1, int(std::ceil(h / (0.2 * step))));
    for (int k = 0; k < parts + (i + 2 == through.size() ? 1 : 0); ++k) {
      const double b = double(k) / parts, a = 1 - b;
      fine.points.push_back(a * through[i] + b * through[i + 1] +
                            h * h / 6 * ((a * a * a - a) * m[i] + (b * b * b - b) * m[i + 1]));
    }
  }
  const std::vector<double> s = arc_lengths(fine.points);
  for (const double x : s) fine.radius.push_back(first_radius + (last_radius - first_radius) * x / s.back());
  return resampled(fine, step);
}

Curve resampled(const Curve& curve, double step) {
  const std::vector<double> s = arc_lengths(curve.points);
  const int n = std::max(1, int(std::lround(s.back() / step)));
  Curve out;
  for (int i = 0; i <= n; ++i) {
    const CurvePoint p = at_share(curve, double(i) / n);
    out.points.push_back(p.point);
    out.radius.push_back(p.radius);
  }
  return out;
}

CurvePoint at_share(const Curve& curve, double share) {
  const std::vector<double> s = arc_lengths(curve.points);
  const double x = std::clamp(share, 0.0, 1.0) * s.back();
  std::size_t i = 1;
  while (i + 1 < s.size() && s[i] < x) ++i;
  const double w = s[i] > s[i - 1] ? std::clamp((x - s[i - 1]) / (s[i] - s[i - 1]), 0.0, 1.0) : 0.0;
  return {(1 - w) * curve.points[i - 1] + w * curve.points[i], (curve.points[i] - curve.points[i - 1]).normalized(),
          (1 - w) * curve.radius[i - 1] + w * curve.radius[i]};
}

}  // namespace insula::artery
