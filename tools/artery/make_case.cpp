// SPDX-License-Identifier: GPL-3.0-or-later
// From a table's entry to a finished vessel.
#include <algorithm>
#include <cmath>
#include <numbers>

#include "shape.h"
#include "vessel.h"

namespace insula::artery {
namespace {

constexpr double extraction_step = 0.4;  // mm; much below the smallest diameter
constexpr double wanted_vertices = 1700;
constexpr double tip_radius = 0.3;  // of the sac's centreline where it ends in the wall
constexpr double neck_band = 0.45;  // mm to either side of the neck's plane
constexpr const char* tube_names[3] = {"parent", "superior", "inferior"};
constexpr const char* cap_names[3] = {"inlet", "superior_outlet", "inferior_outlet"};

CapPlane cap_of(const Shape& shape, int i) {
  const Curve& c = shape.tube(i);
  const std::size_t end = i == 0 ? 0 : c.size() - 1;
  return {cap_names[i], c.points[end], (i == 0 ? -1.0 : 1.0) * c.tangent(end), c.radius[end]};
}

double ramp(double x, double from, double to) { return std::clamp((x - from) / (to - from), 0.0, 1.0); }

/// Edges follow the radius of what they cover, and are shorter at the neck and at the bleb.
double edge_length(const Shape& shape, const Vec3& p) {
  double best = 1e300, radius = 1;
  for (int i = 0; i < 3; ++i) {
    const Curve& c = shape.tube(i);
    for (std::size_t k = 0; k < c.size(); k += 2) {
      const double d = (c.points[k] - p).norm() - c.radius[k];
      if (d < best) best = d, radius = c.radius[k];
    }
  }
  const double tube = 0.485 * std::sqrt(radius);
  const double height = shape.height(p);
  double length = tube + (0.60 - tube) * ramp(height, -0.5, 0.8);
  const bool at_neck = (p - shape.neck_centre()).norm() < 2.5 * shape.neck_radius();
  if (at_neck) length = std::min(length, 0.47 + 0.15 * ramp(std::abs(height), 0.5, 2.0));
  return std::min(length, 0.42 + 0.2 * ramp((p - shape.bleb_centre()).norm(), 1.1 * shape.bleb_radius(),
                                            1.1 * shape.bleb_radius() + 1.5));
}

RemeshGuide guide_of(const Shape& shape, const std::vector<CapPlane>& caps) {
  RemeshGuide g;
  g.edge_length = [&shape](const Vec3& p) { return edge_length(shape, p); };
  g.on_wall = [&shape](const Vec3& p) { return shape.on_surface(p); };
  g.on_cap = [&caps](int cap, const Vec3& p) -> Vec3 {
    const CapPlane& c = caps[std::size_t(cap)];
    return p - (p - c.centre).dot(c.normal) * c.normal;
  };
  g.on_rim = [&shape, &caps](int cap, Vec3 p) -> Vec3 {  // Newton within the plane
    const CapPlane& c = caps[std::size_t(cap)];
    for (int i = 0; i < 10; ++i) {
      p -= (p - c.centre).dot(c.normal) * c.normal;
      const double f = shape.value(p);
      if (std::abs(f) < 1e-7) break;
      Vec3 grad = shape.gradient(p);
      grad -= grad.dot(c.normal) * c.normal;
      p -= f * grad / std::max(grad.squaredNorm(), 0.05);
    }
    return p;
  };
  return g;
}

void name_regions(const Shape& shape, Vessel& v) {
  v.regions = {"parent", "superior", "inferior", "neck", "sac", "bleb", "ends"};
  const std::vector<VertexKind> kinds = vertex_kinds(v.wall);
  for (std::size_t i = 0; i < kinds.size(); ++i) {
    const Vec3& p = v.wall.mesh.vertices[i];
    const double height = shape.height(p);
    const Vec3 across = p - shape.neck_centre() - height * shape.axis();
    int region = int(shape.part(p));  // the order of Part is that of the names, but for the neck
    if (region >= int(Part::sac)) ++region;
    if (region == 4 || region < 3) {
      // A band about the plane; a branch that passes the plane farther out is no neck.
      if (std::abs(height) <= neck_band && across.norm() < shape.neck_radius() + 0.6) region = 3;
      else if (region == 4 && height < 0) region = 3;
    }
    if (kinds[i].cap >= 0) region = 6;
    v.region.push_back(region);
  }
}

}  // namespace

Vessel make_case(const CaseSpec& spec) {
  const Shape shape(spec);
  Vec3 low = shape.sac_centre(), high = low;
  const auto include = [&](const Vec3& p, double r) {
    low = low.cwiseMin(p - Vec3::Constant(r)), high = high.cwiseMax(p + Vec3::Constant(r));
  };
  include(shape.sac_centre(), std::max(spec.width, spec.dome_height));
  include(shape.bleb_centre(), spec.bleb_diameter);
  for (int i = 0; i < 3; ++i)
    for (std::size_t k = 0; k < shape.tube(i).size(); ++k)
      include(shape.tube(i).points[k], shape.tube(i).radius[k] + 2);
  Vessel v;
  v.wall.mesh = extract([&](const Vec3& p) { return shape.value(p); }, low, high, extraction_step);
  v.wall.patch.assign(v.wall.mesh.triangles.size(), -1);
  for (int i = 0; i < 3; ++i) cut_and_close(v.wall, cap_of(shape, i), 3 * cap_of(shape, i).radius);
  const std::vector<CapPlane> caps = v.wall.caps;
  RemeshGuide guide = guide_of(shape, caps);
  const double scale = std::sqrt(expected_vertices(v.wall.mesh, guide.edge_length) / wanted_vertices);
  guide.edge_length = [&shape, scale](const Vec3& p) { return scale * edge_length(shape, p); };
  remesh(v.wall, guide, 8);
  v.picture = subdivided(v.wall, guide).mesh;
  name_regions(shape, v);
  join_fragments(v);

  constexpr double step = 0.5;
  for (int i = 0; i < 3; ++i)
    v.centrelines.push_back({tube_names[i], tube_names[i], i == 0 ? cap_names[0] : "bifurcation",
                             i == 0 ? "bifurcation" : cap_names[i], resampled(shape.tube(i), step)});
  // From the fork through the neck to the dome; the radius is that of the equal section's circle.
  const Vec3 fork = shape.tube(0).points.back(), dome = shape.neck_centre() + shape.dome_height() * shape.axis();
  Curve sac{{fork, dome}, {0, 0}};
  sac = resampled(sac, step);
  for (std::size_t k = 0; k < sac.size(); ++k) {
    const double height = shape.height(sac.points[k]);
    const double section = height < 0
                               ? 2 * shape.neck_radius()
                               : section_diameter(v.wall.mesh, sac.points[k], shape.axis(), 1.5 * shape.sac_radius());
    sac.radius[k] = std::max(0.5 * section, tip_radius);
  }
  v.centrelines.push_back({"sac", "sac", "bifurcation", "dome", sac});

  v.neck = Neck{shape.neck_centre(), shape.axis(), 2 * shape.neck_radius()};
  v.bleb = {shape.bleb_centre(), shape.bleb_radius()};
  measure(v);
  return v;
}

}  // namespace insula::artery
