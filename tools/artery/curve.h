// SPDX-License-Identifier: GPL-3.0-or-later
// A smooth curve with a radius, and the polyline it is worked with. Millimetres throughout tools/artery.
#pragma once
#include <vector>

#include "core/base/math.h"

namespace insula::artery {

struct Curve {
  std::vector<Vec3> points;
  std::vector<double> radius;

  std::size_t size() const { return points.size(); }
  double length() const;
  /// Unit tangent at a point, along the curve.
  Vec3 tangent(std::size_t i) const;
};

/// Natural cubic spline through the points by chord length, sampled every `step`; the radius runs linearly along it.
Curve smooth_curve(const std::vector<Vec3>& through, double first_radius, double last_radius, double step);
/// The same curve with points every `step` (about; both ends are kept).
Curve resampled(const Curve& curve, double step);
/// The point at a share 0..1 of the length.
struct CurvePoint {
  Vec3 point, tangent;
  double radius;
};
CurvePoint at_share(const Curve& curve, double share);

}  // namespace insula::artery
