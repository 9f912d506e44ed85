// SPDX-License-Identifier: GPL-3.0-or-later
// The search for the place: what overlaps costs, and so does leaving the shipped place and directions.
#include <algorithm>
#include <cmath>
#include <numbers>

#include "core/base/input_error.h"
#include "tools/case_builder/place.h"
#include "tools/case_builder/solid.h"

namespace insula::case_builder {
namespace {

constexpr double reach = 12;  // mm, of the turns about the neck's place that are looked at
constexpr double limit = 4;   // mm, beyond which distances do not matter
constexpr double wall_half = 0.15;

Mat3 turn(double angle, const Vec3& axis) { return Eigen::AngleAxisd(angle, axis).toRotationMatrix(); }

/// An orthonormal frame with its third axis along `a`, its first towards `b`.
Mat3 frame(const Vec3& a, const Vec3& b) {
  Vec3 x = b - b.dot(a) * a;
  x = x.norm() > 0.1 ? x.normalized() : Vec3(a.unitOrthogonal());
  Mat3 m;
  m << x, a.cross(x), a;
  return m;
}

struct Turn {
  double spin = 0, tilt_a = 0, tilt_b = 0;
  Vec3 shift = Vec3::Zero();
};

}  // namespace

Placement find_placement(const artery::Vessel& v, const Fissure& fissure, const Options& o, Progress& progress) {
  if (o.in_place) return {};
  if (!v.neck) throw InputError("a vessel without a neck has no place");
  // Where the parent leads when it comes to the neck.
  const auto& parent = v.centrelines.front().curve;
  std::size_t near = 0;
  for (std::size_t k = 0; k < parent.size(); ++k)
    if ((parent.points[k] - v.neck->centre).norm() < (parent.points[near] - v.neck->centre).norm()) near = k;
  const std::size_t back = near > parent.size() / 3 ? near - parent.size() / 3 : 0;
  const Vec3 arrives =
      near > back ? Vec3((parent.points[near] - parent.points[back]).normalized()) : parent.tangent(near);
  const Mat3 base = frame(way_of_sac, way_of_parent) * frame(v.neck->normal, arrives).transpose();

  const Vec3 low = place_of_neck - Vec3::Constant(reach + 4), high = place_of_neck + Vec3::Constant(reach + 4);
  struct Obstacle {
    DistanceGrid grid;
    double weight;
  };
  std::vector<Obstacle> obstacles;
  progress.step("distances in the fissure");
  for (const Lobe& lobe : fissure.lobes)
    obstacles.push_back({DistanceGrid(Solid(lobe.surface), low, high, 0.8, limit), 1});
  obstacles.push_back({DistanceGrid(Solid(fissure.insula), low, high, 0.8, limit), 6});
  obstacles.push_back({DistanceGrid(Solid(fissure.retractors), low, high, 0.8, limit), 6});

  progress.step("looking for the place");
  std::vector<Vec3> samples;
  const auto& all = v.wall.mesh.vertices;
  for (std::size_t i = 0; i < all.size(); i += std::max<std::size_t>(1, all.size() / 350))
    samples.push_back(all[i] - v.neck->centre);
  const Vec3 u = way_of_sac.unitOrthogonal(), w = way_of_sac.cross(u);
  const auto rotation = [&](const Turn& t) -> Mat3 {
    return turn(t.tilt_a, u) * turn(t.tilt_b, w) * turn(t.spin, way_of_sac) * base;
  };
  const double wanted_spin = o.spin * std::numbers::pi / 180;
  const auto cost = [&](const Turn& t) {
    const Mat3 r = rotation(t);
    double sum = 0;
    for (const Vec3& s : samples) {
      const Vec3 p = r * s + place_of_neck + t.shift;
      for (const Obstacle& ob : obstacles)
        if (const double in = o.gap + wall_half - ob.grid.at(p); in > 0) sum += ob.weight * in * in;
    }
    const double away = std::remainder(t.spin - wanted_spin, 2 * std::numbers::pi);
    return sum / double(samples.size()) + 0.25 * (t.tilt_a * t.tilt_a + t.tilt_b * t.tilt_b) +
           0.01 * t.shift.squaredNorm() + (o.keep_spin ? 50 : 0.01) * away * away;
  };
  Turn best;
  double least = 1e300;
  const int spins = o.keep_spin ? 1 : 24;
  for (int i = 0; i < spins; ++i) {
    progress.share(double(i) / spins);
    for (const double a : {-0.35, 0.0, 0.35})
      for (const double b : {-0.35, 0.0, 0.35})
        for (const double x : {-1.5, 1.0})
          for (const double y : {-1.5, 1.0})
            for (const double z : {-1.5, 1.0}) {
              const Turn t{wanted_spin + 2 * std::numbers::pi * i / 24, a, b, Vec3(x, y, z)};
              if (const double c = cost(t); c < least) least = c, best = t;
            }
  }
  for (double step = 1; step > 0.04; step *= 0.5)
    for (bool moved = true; moved;) {
      moved = false;
      for (int k = 0; k < 12; ++k) {
        Turn t = best;
        const double d = (k % 2 ? -1 : 1) * step;
        if (k / 2 == 0) t.spin += 0.15 * d;
        else if (k / 2 == 1) t.tilt_a += 0.15 * d;
        else if (k / 2 == 2) t.tilt_b += 0.15 * d;
        else t.shift[k / 2 - 3] += 0.7 * d;
        if (t.shift.norm() > 4 || std::hypot(t.tilt_a, t.tilt_b) > 0.7) continue;
        if (const double c = cost(t); c < least - 1e-12) least = c, best = t, moved = true;
      }
    }
  Placement p;
  p.rotation = rotation(best);
  p.shift = place_of_neck + best.shift - p.rotation * v.neck->centre;
  return p;
}

artery::Vessel placed(artery::Vessel v, const Placement& p) {
  for (Vec3& x : v.wall.mesh.vertices) x = p.apply(x);
  for (Vec3& x : v.picture.vertices) x = p.apply(x);
  for (artery::CapPlane& cap : v.wall.caps) cap.centre = p.apply(cap.centre), cap.normal = p.rotation * cap.normal;
  for (artery::NamedCurve& c : v.centrelines)
    for (Vec3& x : c.curve.points) x = p.apply(x);
  if (v.neck) v.neck->centre = p.apply(v.neck->centre), v.neck->normal = p.rotation * v.neck->normal;
  if (v.bleb) v.bleb->first = p.apply(v.bleb->first);
  return v;
}

}  // namespace insula::case_builder
