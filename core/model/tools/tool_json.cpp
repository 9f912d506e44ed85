// SPDX-License-Identifier: GPL-3.0-or-later
// What URDF cannot say about a tool: cutting edge, suction opening, a clip's spring, in tool.json beside the URDF.
#include "core/model/tools/tool_json.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <nlohmann/json.hpp>

#include "core/base/text.h"
#include "core/model/formats/file_bytes.h"

namespace insula {
namespace {

using Json = nlohmann::json;
constexpr double mm = 1e-3;

double length_mm(const std::filesystem::path& file, const Json& value, const std::string& what) {
  if (!value.is_number() || !std::isfinite(value.get<double>())) fail(file, what + " must be a number (mm)");
  return value.get<double>() * mm;
}

Vec3 point_mm(const std::filesystem::path& file, const Json& value, const std::string& what) {
  if (!value.is_array() || value.size() != 3) fail(file, what + " must be three numbers (mm)");
  return {length_mm(file, value[0], what), length_mm(file, value[1], what), length_mm(file, value[2], what)};
}

void read_blade(const std::filesystem::path& file, const Json& blade, ToolModel& tool) {
  if (!blade.is_object()) fail(file, "blade must be an object");
  if (blade.contains("cuts") && !blade["cuts"].is_boolean()) fail(file, "blade.cuts must be true or false");
  const bool cuts = blade.value("cuts", true);
  if (!blade.contains("edge")) {
    if (cuts) fail(file, "blade.edge is missing, and the blade cuts");
    return;
  }
  const Json& edge = blade["edge"];
  if (!edge.is_array() || edge.size() < 2 || edge.size() > 1000) fail(file, "blade.edge must be a list of two or more points");
  std::vector<Vec3> points;
  for (std::size_t i = 0; i < edge.size(); ++i) points.push_back(point_mm(file, edge[i], "blade.edge[" + std::to_string(i) + "]"));
  if (!cuts) return;
  for (std::size_t i = 1; i < points.size(); ++i)
    if ((points[i] - points[i - 1]).norm() > 1e-9) tool.blade_edges.push_back({points[i - 1], points[i]});
  if (tool.blade_edges.empty()) fail(file, "blade.edge has no length");
}

const Json& member(const std::filesystem::path& file, const Json& object, const char* key, const std::string& where) {
  if (!object.contains(key)) fail(file, where + "." + key + " is missing");
  return object[key];
}

/// A required number within [least, most], both in the unit of the file.
double in_range(const std::filesystem::path& file, const Json& object, const char* key, const std::string& where, double least, double most) {
  const Json& value = member(file, object, key, where);
  const double x = value.is_number() ? value.get<double>() : std::nan("");
  if (!(x >= least && x <= most)) fail(file, where + "." + key + " must be a number from " + Json(least).dump() + " to " + Json(most).dump());
  return x;
}

std::string word(const std::filesystem::path& file, const Json& object, const char* key, const std::string& where) {
  const Json& value = member(file, object, key, where);
  const std::string text = value.is_string() ? value.get<std::string>() : std::string();
  const bool good = !text.empty() && text.size() <= 40 && text.find_first_not_of("abcdefghijklmnopqrstuvwxyz0123456789_") == std::string::npos;
  if (!good) fail(file, where + "." + key + " must be a word of small letters, digits and _");
  return text;
}

Vec3 direction(const std::filesystem::path& file, const Json& value, const std::string& what) {
  const Vec3 d = point_mm(file, value, what);
  if (!(d.norm() > 1e-9)) fail(file, what + " must not be zero");
  return d.normalized();
}

double distance_to_axis(const Vec3& p, const Hinge& hinge) { return (p - hinge.origin).cross(hinge.axis).norm(); }

void read_blade_line(const std::filesystem::path& file, const Json& clip, const ToolModel& tool, ClipData& out) {
  out.blade_from = point_mm(file, member(file, clip, "blade_from", "clip"), "clip.blade_from");
  out.blade_to = point_mm(file, member(file, clip, "blade_to", "clip"), "clip.blade_to");
  out.blade_line = {out.blade_from, out.blade_to};
  if (clip.contains("blade_line")) {
    const Json& line = clip["blade_line"];
    if (!line.is_array() || line.size() < 2 || line.size() > 1000) fail(file, "clip.blade_line must be a list of two or more points");
    out.blade_line.clear();
    for (std::size_t i = 0; i < line.size(); ++i) out.blade_line.push_back(point_mm(file, line[i], "clip.blade_line[" + std::to_string(i) + "]"));
    if ((out.blade_line.front() - out.blade_from).norm() > 1e-6 || (out.blade_line.back() - out.blade_to).norm() > 1e-6)
      fail(file, "clip.blade_line must run from blade_from to blade_to");
  }
  double length = 0, nearest = std::numeric_limits<double>::infinity(), farthest = 0;
  for (std::size_t i = 0; i < out.blade_line.size(); ++i) {
    if (i > 0) length += (out.blade_line[i] - out.blade_line[i - 1]).norm();
    nearest = std::min(nearest, distance_to_axis(out.blade_line[i], tool.hinges.front()));
    farthest = std::max(farthest, distance_to_axis(out.blade_line[i], tool.hinges.front()));
  }
  if (std::abs(length - out.blade_length) > 0.02 * out.blade_length) fail(file, "clip.blade_length_mm differs from the length of the clamping line");
  if (out.reference < nearest - 1e-4 || out.reference > farthest + 1e-4)
    fail(file, "clip.reference_mm must be the distance from the hinge to a point of the blade");
}

void read_clip(const std::filesystem::path& file, const Json& clip, ToolModel& tool) {
  if (!clip.is_object()) fail(file, "clip must be an object");
  const bool jaws = tool.hinges.size() == 2 && tool.hinges[0].multiplier * tool.hinges[1].multiplier *
      tool.hinges[0].axis.dot(tool.hinges[1].axis) < -1 + 1e-6 && distance_to_axis(tool.hinges[1].origin, tool.hinges[0]) < 1e-6;
  if (!jaws) fail(file, "a clip needs a URDF with two jaws that turn about one axis, opposite to each other");
  if (tool.opening_min > 0 || !(tool.opening_max > 0)) fail(file, "the jaws of a clip close at the angle 0 and open to a positive one");
  ClipData out;
  out.kind = word(file, clip, "kind", "clip");
  const auto kinds = {"permanent", "temporary", "mini", "mini_temporary"};
  if (std::find(kinds.begin(), kinds.end(), out.kind) == kinds.end()) fail(file, "clip.kind must be permanent, temporary, mini or mini_temporary");
  out.shape = word(file, clip, "shape", "clip");
  out.blade_length = in_range(file, clip, "blade_length_mm", "clip", 0.5, 60) * mm;
  out.blade_width = in_range(file, clip, "blade_width_mm", "clip", 0.1, 10) * mm;
  out.closing_force = in_range(file, clip, "closing_force_N", "clip", 0.01, 20);
  out.force_slope = in_range(file, clip, "force_slope_N_per_m", "clip", 0, 1e5);
  out.reference = in_range(file, clip, "reference_mm", "clip", 0.5, 100) * mm;
  out.friction = in_range(file, clip, "friction", "clip", 0, 2);
  read_blade_line(file, clip, tool, out);
  const Json& grip = member(file, clip, "grip", "clip");
  if (!grip.is_object()) fail(file, "clip.grip must be an object");
  out.grip.p = point_mm(file, member(file, grip, "position", "clip.grip"), "clip.grip.position");
  const Vec3 z = direction(file, member(file, grip, "shaft", "clip.grip"), "clip.grip.shaft");
  const Vec3 flat = direction(file, member(file, grip, "flat", "clip.grip"), "clip.grip.flat");
  if (!(z.cross(flat).norm() > 1e-3)) fail(file, "clip.grip.flat must not be parallel to clip.grip.shaft");
  const Vec3 x = (flat - flat.dot(z) * z).normalized();
  Mat3 r;
  r << x, z.cross(x), z;
  out.grip.q = Quat(r).normalized();
  if (clip.contains("fenestration")) {
    const Json& hole = clip["fenestration"];
    if (!hole.is_object()) fail(file, "clip.fenestration must be an object");
    Fenestration f;
    f.centre = point_mm(file, member(file, hole, "centre", "clip.fenestration"), "clip.fenestration.centre");
    f.axis = direction(file, member(file, hole, "axis", "clip.fenestration"), "clip.fenestration.axis");
    f.radius = 0.5 * in_range(file, hole, "diameter_mm", "clip.fenestration", 0.1, 40) * mm;
    out.fenestration = f;
  }
  tool.clip = std::move(out);
}

/// {"piece": radius, ...}: the hull of that piece is the core of a rounded one.
void read_rounding(const std::filesystem::path& file, const Json& rounding, ToolModel& tool) {
  if (!rounding.is_object()) fail(file, "rounding_mm must be an object");
  for (const auto& [name, value] : rounding.items()) {
    const auto piece = std::find_if(tool.pieces.begin(), tool.pieces.end(), [&](const ConvexPiece& p) { return p.name == name; });
    if (piece == tool.pieces.end()) fail(file, "rounding_mm names the collision " + in_quotes(name) + ", which the URDF lacks");
    const double radius = length_mm(file, value, "rounding_mm of " + in_quotes(name));
    if (!(radius >= 0 && radius <= 0.1)) fail(file, "rounding_mm of " + in_quotes(name) + " must lie between 0 and 100");
    piece->radius = radius;
  }
}

}  // namespace

void read_tool_json(const std::filesystem::path& file, ToolModel& tool) {
  std::error_code error;
  if (!std::filesystem::exists(file, error)) return;
  Json json;
  try {
    json = Json::parse(read_file_bytes(file, 1u << 20));
  } catch (const Json::exception& e) {
    fail(file, "is no valid JSON: " + shown(e.what()));
  }
  if (!json.is_object()) fail(file, "must hold one object");
  if (json.contains("unit") && json["unit"] != "mm") fail(file, "unit must be \"mm\"");
  if (json.contains("tip")) {
    const Json& tip = json["tip"];
    if (!tip.is_object()) fail(file, "tip must be an object");
    if (tip.contains("inner_radius_mm")) {
      tool.tip_inner_radius = length_mm(file, tip["inner_radius_mm"], "tip.inner_radius_mm");
      if (!(tool.tip_inner_radius > 0)) fail(file, "tip.inner_radius_mm must be positive");
    }
  }
  if (json.contains("blade")) read_blade(file, json["blade"], tool);
  if (json.contains("rounding_mm")) read_rounding(file, json["rounding_mm"], tool);
  if (json.contains("clip")) read_clip(file, json["clip"], tool);
}

}  // namespace insula
