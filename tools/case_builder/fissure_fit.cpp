// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/case_builder/fissure_fit.h"

#include <Eigen/Geometry>
#include <cmath>

#include "core/base/input_error.h"
#include "core/collision/shapes/closest.h"

namespace insula::case_builder {
namespace {

const Vec3 field_centre{61, 11, -1};  // of the openings: between the arms of exercise 2 and the strands of exercise 1
constexpr double field_radius = 16;   // mm
constexpr int rounds = 60;

Vec3 nearest_on(const std::vector<Vec3>& line, const Vec3& p) {
  Vec3 best = line.front();
  for (std::size_t i = 0; i + 1 < line.size(); ++i) {
    const Vec3 q = line[i] + closest_on_segment(p, line[i], line[i + 1]) * (line[i + 1] - line[i]);
    if ((q - p).squaredNorm() < (best - p).squaredNorm()) best = q;
  }
  return best;
}

/// Points of the lines, one to each wanted point.
std::vector<Vec3> pairs(const Course& wanted, const Course& course) {
  std::vector<Vec3> out;
  for (const Vec3& p : wanted.superficial) out.push_back(nearest_on(course.superficial, p));
  for (const Vec3& p : wanted.deep) out.push_back(nearest_on(course.deep, p));
  return out;
}

std::vector<Vec3> all_of(const Course& c) {
  std::vector<Vec3> out = c.superficial;
  out.insert(out.end(), c.deep.begin(), c.deep.end());
  return out;
}

}  // namespace

Course course_of(const mesh_tool::Cleft& cleft) {
  Course c;
  for (const mesh_tool::CleftStation& s : cleft.stations)
    c.superficial.emplace_back(s.superficial[0], s.superficial[1], s.superficial[2]),
        c.deep.emplace_back(s.deep[0], s.deep[1], s.deep[2]);
  return c;
}

fs::path course_file(const Approach& approach) { return approach.folder / "fissure.json"; }

Course shipped_course(const Approach& approach) {
  const fs::path file = course_file(approach);
  Course c;
  const Json json = read_json(file);
  for (const Json& s : json.at("stations")) {
    const Vec3 p = vec3_from(s.at("superficial"));
    if ((p - field_centre).norm() < field_radius) c.superficial.push_back(p), c.deep.push_back(vec3_from(s.at("deep")));
  }
  if (c.superficial.size() < 3)
    throw InputError(file.string() + ": has fewer than three stations in the field of the exercises");
  return c;
}

double distance(const Course& wanted, const Course& course) {
  const std::vector<Vec3> p = all_of(wanted), q = pairs(wanted, course);
  double sum = 0;
  for (std::size_t i = 0; i < p.size(); ++i) sum += (p[i] - q[i]).squaredNorm();
  return std::sqrt(sum / double(p.size()));
}

Placement fit(const Course& wanted, const Course& course) {
  const std::vector<Vec3> p = all_of(wanted);
  Placement out;
  for (int round = 0; round < rounds; ++round) {
    const Course there = moved(course, out);
    const std::vector<Vec3> q = pairs(wanted, there);
    Eigen::Matrix3Xd from(3, Eigen::Index(p.size())), to = from;
    for (std::size_t i = 0; i < p.size(); ++i) from.col(Eigen::Index(i)) = q[i], to.col(Eigen::Index(i)) = p[i];
    const Eigen::Matrix4d step = Eigen::umeyama(from, to, false);
    const Mat3 turn = step.topLeftCorner<3, 3>();
    out.rotation = turn * out.rotation;
    out.shift = turn * out.shift + step.topRightCorner<3, 1>();
  }
  return out;
}

Course moved(Course c, const Placement& placement) {
  for (auto* line : {&c.superficial, &c.deep})
    for (Vec3& p : *line) p = placement.apply(p);
  return c;
}

}  // namespace insula::case_builder
