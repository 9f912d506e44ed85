// SPDX-License-Identifier: GPL-3.0-or-later
// The artery as an implicit function.
#include "shape.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

namespace insula::artery {
namespace {

constexpr double curve_step = 0.25, past_the_cap = 1.0;
constexpr double fork_blend = 0.6, neck_blend = 0.5, bleb_blend = 0.3;  // mm over which two parts flow together

/// Smooth minimum: equal to the smaller value where they differ by more than k, C1 everywhere.
double smooth_min(double a, double b, double k) {
  const double h = std::max(k - std::abs(a - b), 0.0) / k;
  return std::min(a, b) - 0.25 * k * h * h;
}
double smooth_max(double a, double b, double k) { return -smooth_min(-a, -b, k); }

void extend(Curve& curve, bool at_start) {
  if (at_start) {
    curve.points.insert(curve.points.begin(), curve.points.front() - past_the_cap * curve.tangent(0));
    curve.radius.insert(curve.radius.begin(), curve.radius.front());
  } else {
    curve.points.push_back(curve.points.back() + past_the_cap * curve.tangent(curve.size() - 1));
    curve.radius.push_back(curve.radius.back());
  }
}

}  // namespace

Shape::Shape(const CaseSpec& spec) : axis_(spec.projection) {
  const VesselSpec* vessels[3] = {&spec.parent, &spec.superior, &spec.inferior};
  for (int i = 0; i < 3; ++i) {
    const VesselSpec& v = *vessels[i];
    tubes_[i] = smooth_curve(v.points, 0.5 * v.first_diameter, 0.5 * v.last_diameter, curve_step);
    extended_[i] = tubes_[i];
    extend(extended_[i], i == 0);
  }
  const double parent_radius = 0.5 * spec.parent.last_diameter;
  neck_centre_ = spec.parent.points.back() + (parent_radius + 0.35) * axis_;
  neck_radius_ = 0.5 * spec.neck;
  dome_height_ = spec.dome_height;
  a_ = 0.5 * spec.width;
  double funnel = neck_radius_;
  for (int i = 0; i < 12; ++i) {  // smooth joints widen the neck a little, so the funnel is corrected
    place_sac(funnel);
    const double excess = 0.5 * neck_section_diameter() - neck_radius_;
    funnel = std::min(funnel - excess, 0.995 * a_);
  }
  bleb_radius_ = 0.5 * spec.bleb_diameter;
  const Vec3 side = (spec.bleb_towards - spec.bleb_towards.dot(axis_) * axis_).normalized();
  const Vec3 along = std::cos(spec.bleb_tilt) * axis_ + std::sin(spec.bleb_tilt) * side;
  const double ca = along.dot(axis_), sa = along.dot(side);
  const double to_wall = 1 / std::sqrt(ca * ca / (c_ * c_) + sa * sa / (a_ * a_));
  bleb_centre_ = sac_centre_ + (to_wall + 0.25 * bleb_radius_) * along;
  has_bleb_ = true;
}

void Shape::place_sac(double funnel_radius) {
  funnel_ = funnel_radius;
  const double s = std::sqrt(std::max(0.0, 1 - funnel_ * funnel_ / (a_ * a_)));
  c_ = dome_height_ / (1 + s);
  sac_centre_ = neck_centre_ + s * c_ * axis_;
}

double Shape::tube_value(int i, const Vec3& p) const {
  const Curve& t = extended_[i];
  double best = std::numeric_limits<double>::infinity();
  for (std::size_t k = 0; k + 1 < t.size(); ++k) {
    const Vec3 e = t.points[k + 1] - t.points[k], d = p - t.points[k];
    const double w = std::clamp(d.dot(e) / e.squaredNorm(), 0.0, 1.0);
    best = std::min(best, (d - w * e).norm() - ((1 - w) * t.radius[k] + w * t.radius[k + 1]));
  }
  return best;
}

double Shape::tubes_value(const Vec3& p) const {
  return smooth_min(smooth_min(tube_value(1, p), tube_value(2, p), fork_blend), tube_value(0, p), fork_blend);
}

double Shape::sac_value(const Vec3& p) const {
  const Vec3 d = p - sac_centre_;
  const double h = d.dot(axis_);
  const double rho = std::sqrt(std::max((d - h * axis_).squaredNorm(), 1e-12));
  // Ellipsoid: value over gradient of the scaled radius is the distance to first order.
  const double k = std::sqrt(h * h / (c_ * c_) + rho * rho / (a_ * a_));
  const double slope = std::sqrt(h * h / (c_ * c_ * c_ * c_) + rho * rho / (a_ * a_ * a_ * a_));
  const double ellipsoid = k > 1e-6 && slope > 0 ? k * (k - 1) / slope : -std::min(a_, c_);
  // Funnel: the sac opens by 45 degrees at most, so below the neck's plane it narrows into the fork.
  const double over = height(p);
  const double funnel = (rho - funnel_ - over) * std::numbers::sqrt2 / 2;
  return smooth_max(ellipsoid, funnel, 0.4);
}

double Shape::value(const Vec3& p) const {
  const double body = smooth_min(tubes_value(p), sac_value(p), neck_blend);
  return has_bleb_ ? smooth_min(body, bleb_value(p), bleb_blend) : body;
}

Vec3 Shape::gradient(const Vec3& p) const {
  constexpr double h = 1e-4;
  Vec3 g;
  for (int i = 0; i < 3; ++i) {
    const Vec3 e = h * Vec3::Unit(i);
    g[i] = (value(p + e) - value(p - e)) / (2 * h);
  }
  return g;
}

Vec3 Shape::on_surface(Vec3 p) const {
  for (int i = 0; i < 8; ++i) {
    const double f = value(p);
    if (std::abs(f) < 1e-7) break;
    const Vec3 g = gradient(p);
    p -= std::clamp(f, -0.5, 0.5) * g / std::max(g.squaredNorm(), 0.05);
  }
  return p;
}

Part Shape::part(const Vec3& p) const {
  const double sac = sac_value(p), bleb = bleb_value(p);
  const double tubes[3] = {tube_value(0, p), tube_value(1, p), tube_value(2, p)};
  const double tube = std::min({tubes[0], tubes[1], tubes[2]});
  if (bleb < sac && bleb < tube) return Part::bleb;
  if (sac < tube) return Part::sac;
  if (tubes[0] <= tubes[1] && tubes[0] <= tubes[2]) return Part::parent;
  return tubes[1] <= tubes[2] ? Part::superior : Part::inferior;
}

double Shape::neck_section_diameter() const {
  const Vec3 e1 = axis_.unitOrthogonal(), e2 = axis_.cross(e1);
  constexpr int rays = 48;
  double area = 0;
  for (int i = 0; i < rays; ++i) {
    const double angle = 2 * std::numbers::pi * i / rays;
    const Vec3 d = std::cos(angle) * e1 + std::sin(angle) * e2;
    double in = 0, out = 0.1;
    while (out < 2 * a_ + 2 && value(neck_centre_ + out * d) < 0) in = out, out += 0.1;
    for (int k = 0; k < 30; ++k) {
      const double middle = 0.5 * (in + out);
      (value(neck_centre_ + middle * d) < 0 ? in : out) = middle;
    }
    area += std::numbers::pi / rays * in * in;
  }
  return 2 * std::sqrt(area / std::numbers::pi);
}

}  // namespace insula::artery
