// SPDX-License-Identifier: GPL-3.0-or-later
#include "plugins/micro_doppler/beam.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>

namespace insula {
namespace {

constexpr double least_radius = 1e-6;  // m; a narrower lumen holds no blood that could be heard

/// A piece in the coordinates of its axis and of the beam's parameter t, m from the face.
struct Cone {
  Vec3 to_face, axis;
  double length, foot, rate, widening, radius;
  Cone(const Beam& beam, const LumenPiece& p) : to_face(beam.face - p.a.centre), axis(p.b.centre - p.a.centre) {
    length = axis.norm();
    axis = length > 0 ? Vec3(axis / length) : Vec3::UnitZ();
    foot = to_face.dot(axis);
    rate = beam.along.dot(axis);
    widening = length > 0 ? (p.b.radius - p.a.radius) / length : 0;
    radius = p.a.radius;
  }
  double height(double t) const { return foot + t * rate; }
  double radius_at(double t) const { return radius + widening * height(t); }
};

/// Of the blood in a piece at a height along its axis: component along the beam, or mixed speed of a sac, m/s.
double speed_at(const LumenPiece& p, const Cone& cone, double t) {
  const double share = std::clamp(cone.height(t) / cone.length, 0.0, 1.0);
  const double r = cone.radius_at(t);
  if (r < least_radius) return 0;
  const double area = std::numbers::pi * r * r;
  const double through = ((1 - share) * p.a.flow + share * p.b.flow) / area * -cone.rate;
  // Half of a sac's section takes blood in and the other half lets it out; a beam sees half of a speed without a
  // direction.
  return p.sac ? std::abs(through) + 0.5 * p.exchange / (0.5 * area) : through;
}

/// Sums over the chords in one vessel.
struct Heard {
  double blood = 0, speed = 0, depth = 0, begins = std::numeric_limits<double>::infinity();
  bool sac = false;
  void add(const Beam& beam, const LumenPiece& p) {
    const auto [from, to] = chord_of(beam, p);
    if (!(to > from)) return;
    const Cone cone(beam, p);
    const double weight = to - from, middle = 0.5 * (from + to);
    blood += weight;
    // Simpson's rule: the speed changes along a chord in a lumen that narrows.
    speed += weight / 6 * (speed_at(p, cone, from) + 4 * speed_at(p, cone, middle) + speed_at(p, cone, to));
    depth += weight * middle;
    begins = std::min(begins, from);
    sac = p.sac;
  }
};

}  // namespace

Chord chord_of(const Beam& beam, const LumenPiece& piece) {
  const Cone c(beam, piece);
  double low = beam.nearest, high = beam.farthest;
  if (!(c.length > 0) || (piece.a.radius < least_radius && piece.b.radius < least_radius)) return {};
  // Between the two ends of the axis.
  if (std::abs(c.rate) > 1e-12) {
    const double s = -c.foot / c.rate, e = (c.length - c.foot) / c.rate;
    low = std::max(low, std::min(s, e));
    high = std::min(high, std::max(s, e));
  } else if (c.foot < 0 || c.foot > c.length) {
    return {};
  }
  if (!(high > low)) return {};
  // Distance from the axis below the radius: a t^2 + 2 b t + k < 0.
  const double across = c.rate * c.rate * (1 + c.widening * c.widening), r = c.radius + c.widening * c.foot;
  const double a = 1 - across, b = c.to_face.dot(beam.along) - c.foot * c.rate - c.widening * c.rate * r,
               k = c.to_face.squaredNorm() - c.foot * c.foot - r * r;
  const auto inside = [&](double t) { return (a * t + 2 * b) * t + k < 0; };
  std::array<double, 4> at{low, low, high, high};
  if (std::abs(a) < 1e-12) {
    if (std::abs(b) > 1e-15) at[1] = std::clamp(-k / (2 * b), low, high);
  } else if (const double root = b * b - a * k; root > 0) {
    at[1] = std::clamp((-b - std::sqrt(root)) / a, low, high);
    at[2] = std::clamp((-b + std::sqrt(root)) / a, low, high);
  }
  std::sort(at.begin(), at.end());
  // A frustum is convex, so what lies inside is one chord.
  Chord out;
  for (std::size_t i = 0; i < 3; ++i) {
    if (!(at[i + 1] > at[i]) || !inside(0.5 * (at[i] + at[i + 1]))) continue;
    if (!(out.to > out.from)) out.from = at[i];
    out.to = at[i + 1];
  }
  return out;
}

Insonation insonate(const Beam& beam, std::span<const LumenPiece> pieces) {
  Insonation best;
  double begins = std::numeric_limits<double>::infinity();
  for (std::size_t i = 0; i < pieces.size();) {
    Heard h;
    do h.add(beam, pieces[i++]);
    while (i < pieces.size() && !pieces[i].first);
    if (!(h.blood > 0)) continue;
    const double speed = h.speed / h.blood;
    const bool heard = std::abs(speed) > beam.wall_filter;
    if (best.lumen && (best.heard != heard ? best.heard : begins <= h.begins)) continue;
    begins = h.begins;
    best = {true, h.sac, speed, h.depth / h.blood, heard};
  }
  return best;
}

}  // namespace insula
