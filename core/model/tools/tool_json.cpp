// SPDX-License-Identifier: GPL-3.0-or-later
// Reads tool.json: properties of a tool that URDF does not have.
#include "core/model/tools/tool_json.h"

#include <algorithm>

#include "core/base/text.h"
#include "core/model/formats/json_length.h"

namespace insula {
namespace {

using Json = nlohmann::json;

void read_blade(const std::filesystem::path& file, const Json& blade, ToolModel& tool) {
  if (!blade.is_object()) fail(file, "blade must be an object");
  if (blade.contains("cuts") && !blade["cuts"].is_boolean()) fail(file, "blade.cuts must be true or false");
  const bool cuts = blade.value("cuts", true);
  if (!blade.contains("edge")) {
    if (cuts) fail(file, "blade.edge is missing, and the blade cuts");
    return;
  }
  const Json& edge = blade["edge"];
  if (!edge.is_array() || edge.size() < 2 || edge.size() > 1000)
    fail(file, "blade.edge must be a list of two or more points");
  std::vector<Vec3> points;
  for (std::size_t i = 0; i < edge.size(); ++i)
    points.push_back(point_mm(file, edge[i], "blade.edge[" + std::to_string(i) + "]"));
  if (!cuts) return;
  for (std::size_t i = 1; i < points.size(); ++i)
    if ((points[i] - points[i - 1]).norm() > 1e-9) tool.blade_edges.push_back({points[i - 1], points[i]});
  if (tool.blade_edges.empty()) fail(file, "blade.edge has no length");
}

/// {"piece": radius, ...}: the hull of that piece is the core of a rounded one.
void read_rounding(const std::filesystem::path& file, const Json& rounding, ToolModel& tool) {
  if (!rounding.is_object()) fail(file, "rounding_mm must be an object");
  for (const auto& entry : rounding.items()) {
    const std::string& name = entry.key();
    const Json& value = entry.value();
    const auto piece =
        std::find_if(tool.pieces.begin(), tool.pieces.end(), [&](const ConvexPiece& p) { return p.name == name; });
    if (piece == tool.pieces.end())
      fail(file, "rounding_mm names the collision " + in_quotes(name) + ", which the URDF lacks");
    const double radius = length_mm(file, value, "rounding_mm of " + in_quotes(name));
    if (!(radius >= 0 && radius <= 0.1))
      fail(file, "rounding_mm of " + in_quotes(name) + " must lie between 0 and 100");
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
  tool.json_file = file;
  for (const auto& [key, value] : json.items())
    if (key != "unit" && key != "tip" && key != "blade" && key != "rounding_mm")
      tool.sections.emplace(key, value.dump());
}

}  // namespace insula
