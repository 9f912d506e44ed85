// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/case_builder/sight.h"

#include <algorithm>

#include "core/base/input_error.h"
#include "tools/case_builder/neck_frame.h"
#include "tools/case_builder/unit_options.h"

namespace insula::case_builder {
namespace {

constexpr double before_wall =
    0.1;  // mm: so far before the wall a line begins, so that it does not meet its own triangle
constexpr std::size_t most_lines = 40;

Vec3 eye_of(const Approach& approach) {
  std::string why;
  const auto eye = read_shape(approach.clipping.view.eye, Shape::point, why);
  if (!eye) throw InputError("the eye of the approach " + approach.name + ": " + why);
  return {(*eye)[0], (*eye)[1], (*eye)[2]};
}

struct Start {
  Vec3 at, outward;
};

/// Points of the neck's line whose side faces the eye.
std::vector<Start> near_side(const artery::Vessel& v, const Vec3& eye) {
  std::vector<Start> out;
  for (const auto& ends : neck_line(v)) {
    const Vec3 at = ends[0].in(v.wall.mesh.vertices), from_middle = at - v.neck->centre;
    const Vec3 outward = (from_middle - from_middle.dot(v.neck->normal) * v.neck->normal).normalized();
    if (outward.dot(eye - at) > 0) out.push_back({at, outward});
  }
  std::vector<Start> some;
  const std::size_t every = std::max<std::size_t>(1, out.size() / most_lines);
  for (std::size_t k = 0; k < out.size(); k += every) some.push_back(out[k]);
  return some;
}

}  // namespace

double first_meeting(const TriMesh& mesh, const Vec3& from, const Vec3& to) {
  const Vec3 along = to - from;
  double first = 2;
  for (const auto& t : mesh.triangles) {
    const Vec3 &a = mesh.vertices[std::size_t(t[0])], u = mesh.vertices[std::size_t(t[1])] - a,
               w = mesh.vertices[std::size_t(t[2])] - a, p = along.cross(w);
    const double det = u.dot(p);
    if (det == 0) continue;
    const Vec3 s = from - a, q = s.cross(u);
    const double x = s.dot(p) / det, y = along.dot(q) / det, share = w.dot(q) / det;
    if (x >= 0 && y >= 0 && x + y <= 1 && share > 0 && share <= 1) first = std::min(first, share);
  }
  return first;
}

Sight sight_of_neck(const artery::Vessel& v, const Fissure& fissure) {
  if (!v.neck) throw InputError("a vessel without a neck is not looked at");
  const Vec3 eye = eye_of(fissure.approach);
  std::vector<std::pair<std::string, const TriMesh*>> all;
  for (const Lobe& lobe : fissure.lobes) all.emplace_back(lobe.name, &lobe.surface);
  all.emplace_back(fissure.approach.floor, &fissure.floor);
  for (const Fissure::Rigid& rigid : fissure.obstacles) all.emplace_back(rigid.name, &rigid.mesh);
  all.emplace_back("retractors", &fissure.retractors);
  all.emplace_back("vessel", &v.wall.mesh);
  const std::vector<Start> starts = near_side(v, eye);
  Sight out;
  const double share = starts.empty() ? 0 : 1.0 / double(starts.size());
  for (const Start& start : starts) {
    const Vec3 from = start.at + before_wall * start.outward;
    double least = 2;
    std::string what;
    for (const auto& [name, mesh] : all)
      if (const double at = first_meeting(*mesh, from, eye); at < least) least = at, what = name;
    if (what.empty()) {
      out.seen += share;
      continue;
    }
    const auto known =
        std::find_if(out.hidden.begin(), out.hidden.end(), [&](const auto& one) { return one.first == what; });
    if (known == out.hidden.end()) out.hidden.emplace_back(what, share);
    else known->second += share;
  }
  return out;
}

}  // namespace insula::case_builder
