// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/case_builder/wall_patches.h"

#include <fmt/format.h>

#include <algorithm>
#include <limits>

#include "core/base/input_error.h"
#include "core/base/text.h"
#include "core/model/geometry/triangle_distance.h"
#include "tools/case_builder/assignment.h"
#include "tools/case_builder/region_walls.h"
#include "tools/case_builder/unit_options.h"

namespace insula::case_builder {
namespace {

constexpr double sure = 0.95;  // of the radius: farther points are off the wall, also once the scene has rounded them

[[noreturn]] void refuse_patch(const std::string& text, const std::string& why) {
  throw InputError("--wall-patch " + text + ": " + why);
}

void take_value(WallPatch& out, const Assignment& given_value, const std::string& text) {
  const auto& [name, value] = given_value;
  const std::string given = "--wall-patch " + text + ": " + name;
  if (name == "radius") out.radius_mm = 1e3 * wall_value("spot_radius", value, given);
  else if (name == "thickness" || name == "young") {
    wall_value(name, value, given);
    (name == "young" ? out.young : out.thickness) = value;
  } else {
    refuse_patch(text, "a patch has no " + in_quotes(name) + "; it has radius, thickness and young");
  }
}

void take_point(WallPatch& out, const std::string& part, const std::string& text) {
  std::string why;
  const auto numbers = read_shape(part, Shape::point, why);
  if (!numbers) refuse_patch(text, why);
  out.points.push_back({(*numbers)[0], (*numbers)[1], (*numbers)[2]});
}

Vec3 vector(const Point& p) { return {p[0], p[1], p[2]}; }

/// How far a point is from the wall without its caps, mm.
double off_wall(const artery::Vessel& v, const Vec3& p) {
  double least = std::numeric_limits<double>::max();
  const auto& x = v.wall.mesh.vertices;
  for (std::size_t t = 0; t < v.wall.mesh.triangles.size(); ++t) {
    if (v.wall.patch[t] >= 0) continue;
    const auto& c = v.wall.mesh.triangles[t];
    const Vec3 near = nearest_on_triangle(p, x[std::size_t(c[0])], x[std::size_t(c[1])], x[std::size_t(c[2])]);
    least = std::min(least, (p - near).norm());
  }
  return least;
}

/// Of the region whose vertex is nearest.
WallOf wall_at(const artery::Vessel& v, const std::vector<WallOf>& walls, const Vec3& p) {
  const auto& x = v.wall.mesh.vertices;
  const auto nearest = std::min_element(
      x.begin(), x.end(), [&](const Vec3& a, const Vec3& b) { return (a - p).squaredNorm() < (b - p).squaredNorm(); });
  const std::string& region = v.regions[std::size_t(v.region[std::size_t(nearest - x.begin())])];
  for (const WallOf& wall : walls) {
    const auto names = split_blanks(wall.regions);
    if (std::find(names.begin(), names.end(), region) != names.end()) return wall;
  }
  return walls.front();
}

}  // namespace

WallPatch read_wall_patch(const std::string& text) {
  WallPatch out;
  for (std::size_t at = 0; at <= text.size();) {
    const std::size_t end = std::min(text.find(',', at), text.size());
    const std::string part = text.substr(at, end - at);
    if (const auto value = read_assignment(part)) take_value(out, *value, text);
    else take_point(out, part, text);
    at = end + 1;
  }
  if (out.points.empty()) refuse_patch(text, "it has no point; write \"X Y Z mm, radius=1 mm, young=7 MPa\"");
  if (out.thickness.empty() && out.young.empty()) refuse_patch(text, "it changes neither thickness nor young");
  return out;
}

std::vector<PatchOf> patches_of(const artery::Vessel& v, const Options& o, std::vector<Note>& notes) {
  std::vector<PatchOf> out;
  const std::vector<WallOf> walls = walls_of(v, o);
  for (std::size_t k = 0; k < o.wall_patches.size(); ++k) {
    const WallPatch& given = o.wall_patches[k];
    PatchOf patch{{}, given.radius_mm, 0, 0};
    for (const Point& p : given.points)
      if (off_wall(v, vector(p)) <= sure * given.radius_mm) patch.spots.push_back(vector(p));
    if (const std::size_t off = given.points.size() - patch.spots.size(); off > 0)
      notes.push_back(problem(
          "patch_off_wall",
          fmt::format("Part {} of the wall that was painted: {} of its {} points are not on the vessel that is kept.",
                      k + 1, off, given.points.size()),
          "Paint nearer to the neck, or keep more of the vessel (--keep)."));
    if (patch.spots.empty()) continue;
    const WallOf around = wall_at(v, walls, patch.spots.front());
    const std::string where = "part " + std::to_string(k + 1) + " of the wall";
    patch.thickness_mm =
        given.thickness.empty() ? around.thickness_mm : 1e3 * wall_value("thickness", given.thickness, where);
    patch.young_mpa = given.young.empty() ? around.young_mpa : 1e-6 * wall_value("young", given.young, where);
    out.push_back(std::move(patch));
  }
  return out;
}

Json to_json(const std::vector<PatchOf>& patches) {
  Json out = Json::array();
  for (const PatchOf& p : patches) {
    Json spots = Json::array();
    for (const Vec3& spot : p.spots) spots.push_back(to_json(spot));
    out.push_back(
        {{"spots", spots}, {"radius_mm", p.radius_mm}, {"thickness_mm", p.thickness_mm}, {"young_MPa", p.young_mpa}});
  }
  return out;
}

std::vector<PatchOf> patches_from(const Json& json) {
  std::vector<PatchOf> out;
  for (const Json& p : json) {
    PatchOf patch{{}, p.at("radius_mm"), p.at("thickness_mm"), p.at("young_MPa")};
    for (const Json& spot : p.at("spots")) patch.spots.push_back(vec3_from(spot));
    out.push_back(std::move(patch));
  }
  return out;
}

}  // namespace insula::case_builder
