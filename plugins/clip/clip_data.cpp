// SPDX-License-Identifier: GPL-3.0-or-later
// Reading and checking the section "clip".
#include "plugins/clip/clip_data.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "core/base/text.h"
#include "core/model/formats/json_length.h"

namespace insula {
namespace {

using Json = nlohmann::json;
constexpr double mm = json_millimetre;

const Json& member(const std::filesystem::path& file, const Json& object, const char* key, const std::string& where) {
  if (!object.contains(key)) fail(file, where + "." + key + " is missing");
  return object[key];
}

/// A required number within [least, most], both in the unit of the file.
double in_range(const std::filesystem::path& file, const Json& object, const char* key, const std::string& where,
                double least, double most) {
  const Json& value = member(file, object, key, where);
  const double x = value.is_number() ? value.get<double>() : std::nan("");
  if (!(x >= least && x <= most))
    fail(file, where + "." + key + " must be a number from " + Json(least).dump() + " to " + Json(most).dump());
  return x;
}

std::string word(const std::filesystem::path& file, const Json& object, const char* key, const std::string& where) {
  const Json& value = member(file, object, key, where);
  const std::string text = value.is_string() ? value.get<std::string>() : std::string();
  const bool good = !text.empty() && text.size() <= 40 &&
                    text.find_first_not_of("abcdefghijklmnopqrstuvwxyz0123456789_") == std::string::npos;
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
    if (!line.is_array() || line.size() < 2 || line.size() > 1000)
      fail(file, "clip.blade_line must be a list of two or more points");
    out.blade_line.clear();
    for (std::size_t i = 0; i < line.size(); ++i)
      out.blade_line.push_back(point_mm(file, line[i], "clip.blade_line[" + std::to_string(i) + "]"));
    if ((out.blade_line.front() - out.blade_from).norm() > 1e-6 || (out.blade_line.back() - out.blade_to).norm() > 1e-6)
      fail(file, "clip.blade_line must run from blade_from to blade_to");
  }
  double length = 0, nearest = std::numeric_limits<double>::infinity(), farthest = 0;
  for (std::size_t i = 0; i < out.blade_line.size(); ++i) {
    if (i > 0) length += (out.blade_line[i] - out.blade_line[i - 1]).norm();
    nearest = std::min(nearest, distance_to_axis(out.blade_line[i], tool.hinges.front()));
    farthest = std::max(farthest, distance_to_axis(out.blade_line[i], tool.hinges.front()));
  }
  if (std::abs(length - out.blade_length) > 0.02 * out.blade_length)
    fail(file, "clip.blade_length_mm differs from the length of the clamping line");
  if (out.reference < nearest - 1e-4 || out.reference > farthest + 1e-4)
    fail(file, "clip.reference_mm must be the distance from the hinge to a point of the blade");
}

ClipData parse_clip(const std::filesystem::path& file, const Json& clip, const ToolModel& tool) {
  if (!clip.is_object()) fail(file, "clip must be an object");
  const bool jaws =
      tool.hinges.size() == 2 &&
      tool.hinges[0].multiplier * tool.hinges[1].multiplier * tool.hinges[0].axis.dot(tool.hinges[1].axis) <
          -1 + 1e-6 &&
      distance_to_axis(tool.hinges[1].origin, tool.hinges[0]) < 1e-6;
  if (!jaws) fail(file, "a clip needs a URDF with two jaws that turn about one axis, opposite to each other");
  if (tool.opening_min > 0 || !(tool.opening_max > 0))
    fail(file, "the jaws of a clip close at the angle 0 and open to a positive one");
  ClipData out;
  out.kind = word(file, clip, "kind", "clip");
  const auto kinds = {"permanent", "temporary", "mini", "mini_temporary"};
  if (std::find(kinds.begin(), kinds.end(), out.kind) == kinds.end())
    fail(file, "clip.kind must be permanent, temporary, mini or mini_temporary");
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
  return out;
}

}  // namespace

std::optional<ClipData> read_clip_data(const ToolModel& tool) {
  const auto section = tool.sections.find("clip");
  if (section == tool.sections.end()) return std::nullopt;
  return parse_clip(tool.json_file, Json::parse(section->second), tool);
}

double ClipData::gap(double opening) const { return 2 * reference * std::sin(opening); }

double ClipData::torque(double opening) const { return reference * (closing_force + force_slope * gap(opening)); }

}  // namespace insula
