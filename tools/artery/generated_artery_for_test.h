// SPDX-License-Identifier: GPL-3.0-or-later
// Arteries with an aneurysm whose neck is known, as implicit functions: what a segmented patient's vessel may look
// like, from a bifurcation to a blister. Millimetres.
#pragma once
#include <algorithm>
#include <cmath>
#include <functional>
#include <numbers>
#include <ostream>
#include <string>
#include <vector>

#include "curve.h"
#include "surface.h"

namespace insula::artery::test {

struct Limb {
  std::string name;
  Curve curve;
  bool capped_first = false, capped_last = false;
};

/// A dome on a wall: an ellipsoid of revolution on a round neck.
struct Dome {
  Vec3 root = Vec3::Zero(), axis = Vec3::UnitZ();  ///< where the axis leaves the vessels' surface; unit, outward
  double neck_diameter = 3;                        ///< of the neck before the fillet
  double radius = 3;                               ///< across the axis
  double half_height = 3;                          ///< along it
  double lift = 0.4;  ///< the ellipsoid's lowest point over the root, in half heights; negative: sunk in
};

struct GeneratedArtery {
  std::string name;
  std::vector<Limb> limbs;
  Dome dome;
  double step = 0.35;   ///< of the grid on which the surface is found
  bool voxels = false;  ///< steps of a label volume, as marching cubes leaves them
  double fillet = 0.3;  ///< between vessels and dome
  double of_vessels(const Vec3& p) const;
  double of_dome(const Vec3& p) const;
  Vec3 dome_centre() const { return dome.root + (dome.lift + 1) * dome.half_height * dome.axis; }
  /// The closed surface with its caps.
  Surface surface() const;
};

/// For the names of tests.
inline void PrintTo(const GeneratedArtery& a, std::ostream* out) { *out << a.name; }

inline double smooth_least(double a, double b, double width) {
  const double h = std::max(width - std::abs(a - b), 0.0) / width;
  return std::min(a, b) - 0.25 * width * h * h;
}

inline double distance_to_curve(const Curve& c, const Vec3& p) {
  double least = 1e300;
  for (std::size_t k = 0; k + 1 < c.size(); ++k) {
    const Vec3 along = c.points[k + 1] - c.points[k];
    const double w = std::clamp((p - c.points[k]).dot(along) / along.squaredNorm(), 0.0, 1.0);
    const double r = (1 - w) * c.radius[k] + w * c.radius[k + 1];
    least = std::min(least, (p - c.points[k] - w * along).norm() - r);
  }
  return least;
}

inline double GeneratedArtery::of_vessels(const Vec3& p) const {
  double d = 1e300;
  for (const Limb& l : limbs) d = smooth_least(d, distance_to_curve(l.curve, p), 0.4);
  return d;
}

inline double GeneratedArtery::of_dome(const Vec3& p) const {
  const Vec3 r = p - dome_centre();
  const double along = r.dot(dome.axis), across = (r - along * dome.axis).norm();
  // First order distance from an ellipsoid: value over gradient.
  const double f = std::sqrt(std::pow(across / dome.radius, 2) + std::pow(along / dome.half_height, 2));
  const double slope =
      std::sqrt(std::pow(across / std::pow(dome.radius, 2), 2) + std::pow(along / std::pow(dome.half_height, 2), 2));
  const double ellipsoid = slope > 1e-9 ? f * (f - 1) / slope : -std::min(dome.radius, dome.half_height);
  const Curve stem{{dome.root - 0.3 * dome.axis, dome_centre()}, {0.5 * dome.neck_diameter, 0.5 * dome.neck_diameter}};
  return smooth_least(ellipsoid, distance_to_curve(stem, p), 0.4);
}

inline Surface GeneratedArtery::surface() const {
  Vec3 low = dome_centre(), high = low;
  const auto include = [&](const Vec3& p, double r) {
    low = low.cwiseMin(p - Vec3::Constant(r)), high = high.cwiseMax(p + Vec3::Constant(r));
  };
  include(dome_centre(), std::max(dome.radius, dome.half_height) + 1);
  for (const Limb& l : limbs)
    for (std::size_t k = 0; k < l.curve.size(); ++k) include(l.curve.points[k], l.curve.radius[k] + 1);
  const auto value = [&](const Vec3& p) { return smooth_least(of_vessels(p), of_dome(p), fillet); };
  Surface s;
  s.mesh = extract([&](const Vec3& p) { return voxels ? (value(p) < 0 ? -1.0 : 1.0) : value(p); }, low, high, step);
  s.patch.assign(s.mesh.triangles.size(), -1);
  for (const Limb& l : limbs) {
    const auto cap = [&](const std::string& name, std::size_t k, double side) {
      // A little within the end, where the tube is no longer round.
      const Vec3 out = side * l.curve.tangent(k);
      const double r = l.curve.radius[k];
      cut_and_close(s, {name, l.curve.points[k] - 0.2 * r * out, out, r}, 2.5 * r);
    };
    if (l.capped_first) cap(l.name + "_first", 0, -1);
    if (l.capped_last) cap(l.name + "_last", l.curve.size() - 1, 1);
  }
  return s;
}

inline Vec3 direction(double polar_deg, double azimuth_deg) {
  const double t = polar_deg * std::numbers::pi / 180, f = azimuth_deg * std::numbers::pi / 180;
  return {std::sin(t) * std::cos(f), std::sin(t) * std::sin(f), std::cos(t)};
}

/// A fork in the plane y = 0 whose parent comes up the z axis and whose dome stands between the branches.
struct Fork {
  double parent = 1.4, first = 1.0, second = 1.1;  ///< radii
  double first_angle = 60, second_angle = 60;      ///< degrees from the parent's direction
  double length = 9;
};
inline GeneratedArtery on_fork(const std::string& name, const Fork& f, Dome dome, double tilt_deg, double azimuth_deg) {
  GeneratedArtery a{name, {}, dome};
  const Vec3 origin = Vec3::Zero();
  const auto branch = [&](double angle, double azimuth, double radius, const std::string& of) {
    const Vec3 d = direction(angle, azimuth), more = direction(std::min(angle + 20, 120.0), azimuth + 8);
    const std::vector<Vec3> through{origin, 0.45 * f.length * d, 0.45 * f.length * d + 0.6 * f.length * more};
    a.limbs.push_back({of, smooth_curve(through, radius, 0.9 * radius, 0.5), false, true});
  };
  a.limbs.push_back(
      {"parent",
       smooth_curve({{0.8, -0.6, -1.1 * f.length}, {0.3, -0.2, -0.5 * f.length}, origin}, f.parent, f.parent, 0.5),
       true, false});
  branch(f.first_angle, 0, f.first, "first");
  branch(f.second_angle, 180, f.second, "second");
  a.dome.axis = direction(tilt_deg, azimuth_deg);
  // From the fork outward to the vessels' surface.
  double reach = 0;
  while (a.of_vessels(reach * a.dome.axis) < 0) reach += 0.01;
  a.dome.root = reach * a.dome.axis;
  return a;
}

/// A dome on the side of a bent vessel, with or without a small branch beside the neck.
struct Side {
  double radius = 1.8;  ///< of the vessel
  double bend = 3;      ///< height of the bend over its chord
  double branch = 0;    ///< radius of a branch at the neck's distal edge; 0: none
};
inline GeneratedArtery on_side(const std::string& name, const Side& v, Dome dome, double along_deg, double around_deg) {
  GeneratedArtery a{name, {}, dome};
  a.limbs.push_back(
      {"parent",
       smooth_curve(
           {{-11, 0, -v.bend}, {-5, 0.4, -0.25 * v.bend}, {0, 0, 0}, {5, -0.4, -0.25 * v.bend}, {11, 0, -v.bend}},
           v.radius, 0.92 * v.radius, 0.5),
       true, true});
  const Vec3 up = direction(along_deg, 0), side{0, 1, 0};
  const double f = around_deg * std::numbers::pi / 180;
  a.dome.axis = (std::cos(f) * up + std::sin(f) * side).normalized();
  double reach = 0;
  while (a.of_vessels(reach * a.dome.axis) < 0) reach += 0.01;
  a.dome.root = reach * a.dome.axis;
  if (v.branch > 0) {
    const double from = 0.5 * dome.neck_diameter + v.branch + 0.5;
    a.limbs.push_back({"branch",
                       smooth_curve({{from, 0, 0}, {from + 2, 0.5, v.radius + 2}, {from + 6, 1, v.radius + 6}},
                                    v.branch, v.branch, 0.4),
                       false, true});
  }
  return a;
}

/// The last branch runs around the dome at a small gap.
inline GeneratedArtery kissing(GeneratedArtery a, double gap) {
  Limb& branch = a.limbs.back();
  const double r = branch.curve.radius.back(), out = a.dome.radius + r + gap, up = a.dome.half_height + r + gap;
  const Vec3 centre = a.dome_centre(), axis = a.dome.axis;
  const Vec3 away = branch.curve.points[branch.curve.size() / 3] - centre;
  const Vec3 beside = (away - away.dot(axis) * axis).normalized();
  const auto around = [&](double degrees) {
    const double f = degrees * std::numbers::pi / 180;
    return Vec3(centre + out * std::cos(f) * beside + up * std::sin(f) * axis);
  };
  branch.curve = smooth_curve(
      {branch.curve.points.front(), around(-50), around(-25), around(0), around(20), around(20) + 4 * (axis + beside)},
      r, r, 0.4);
  return a;
}

/// Thirty arteries: forks, side walls, giant and small domes, blisters, kissing branches, steps of voxels.
inline std::vector<GeneratedArtery> generated_arteries() {
  std::vector<GeneratedArtery> all;
  const auto dome = [](double neck, double radius, double half_height, double lift = 0.3) {
    Dome d;
    d.neck_diameter = neck, d.radius = radius, d.half_height = half_height, d.lift = lift;
    return d;
  };
  all.push_back(on_fork("fork_plain", {}, dome(3, 3, 3), 0, 0));
  all.push_back(on_fork("fork_small_dome", {}, dome(2, 1.6, 1.6), 5, 90));
  all.push_back(on_fork("fork_tall", {}, dome(3, 2.5, 4), 10, 45));
  all.push_back(on_fork("fork_flat", {}, dome(4, 3.5, 2.4), 0, 0));
  all.push_back(on_fork("fork_wide_neck", {1.5, 1.2, 1.2, 70, 70}, dome(5, 3.5, 3.2, 0.1), 0, 0));
  all.push_back(on_fork("fork_tilted_forward", {}, dome(3, 2.8, 3), 35, 90));
  all.push_back(on_fork("fork_tilted_to_branch", {1.4, 1.0, 1.1, 75, 60}, dome(2.6, 2.5, 2.8), 25, 0));
  all.push_back(on_fork("fork_uneven", {1.6, 0.8, 1.4, 80, 35}, dome(3, 2.6, 2.8), 30, 0));
  all.push_back(on_fork("fork_t", {1.3, 1.1, 1.1, 90, 90}, dome(3.2, 3, 3.4), 0, 0));
  all.push_back(on_fork("fork_narrow", {1.3, 1.0, 1.0, 40, 40}, dome(2.4, 2.4, 3, 0.5), 40, 90));
  all.push_back(on_fork("fork_basilar", {1.7, 1.1, 1.1, 85, 85}, dome(4.2, 4, 4.5, 0.2), 5, 180));
  all.push_back(on_fork("fork_small_vessels", {0.9, 0.7, 0.7, 65, 55}, dome(2, 2.2, 2.4), 10, 30));
  all.push_back(on_side("side_plain", {}, dome(3, 3, 3), 0, 0));
  all.push_back(on_side("side_tilted", {}, dome(3, 2.8, 3.4), 20, 0));
  all.push_back(on_side("side_behind", {}, dome(2.6, 2.4, 2.8), 0, 60));
  all.push_back(on_side("side_small", {}, dome(2, 1.7, 1.8), 0, 20));
  all.push_back(on_side("side_carotid", {2.2, 4}, dome(3.6, 3.4, 3.6), 10, 30));
  all.push_back(on_side("side_with_branch", {2, 3, 0.7}, dome(3, 2.8, 3.2), -10, 0));
  all.push_back(on_side("side_with_wide_branch", {2, 3, 1.1}, dome(3.4, 3, 3.2), -15, 10));
  all.push_back(on_side("side_straight", {1.5, 0.2}, dome(2.6, 2.5, 2.8), 0, 0));
  all.push_back(on_fork("giant_fork", {1.7, 1.2, 1.3, 80, 85, 14}, dome(6, 11, 12, 0.2), 5, 0));
  all.push_back(on_side("giant_side", {2.2, 3}, dome(7, 10.5, 11, 0.05), 10, 10));
  all.push_back(on_fork("giant_with_narrow_neck", {1.7, 1.3, 1.3, 75, 75, 14}, dome(4, 9, 10, 0.1), 0, 0));
  all.push_back(on_side("blister", {2, 3}, dome(3, 1.7, 1.6, -0.9), 0, 20));
  all.push_back(on_side("blister_of_the_back", {2, 3}, dome(3.4, 2, 1.9, -0.8), 0, 70));
  all.push_back(kissing(on_fork("kissing_branch", {}, dome(3, 3, 3), 0, 0), 0.5));
  all.push_back(
      kissing(on_fork("kissing_branch_of_a_tall_dome", {1.4, 1, 0.9, 60, 50}, dome(2.8, 2.6, 3.8), 0, 0), 0.6));
  const auto in_voxels = [&](GeneratedArtery a, double step) {
    a.name = "voxels_of_" + a.name, a.voxels = true, a.step = step;
    all.push_back(std::move(a));
  };
  in_voxels(on_fork("fork", {}, dome(3, 3, 3), 0, 0), 0.4);
  in_voxels(on_side("side", {}, dome(3, 3, 3), 10, 20), 0.4);
  in_voxels(on_fork("tall_fork", {1.5, 1.1, 1.2, 65, 65}, dome(3.2, 2.8, 4), 15, 60), 0.5);
  return all;
}

}  // namespace insula::artery::test
