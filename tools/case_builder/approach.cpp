// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/case_builder/approach.h"

#include <algorithm>

#include "core/base/input_error.h"
#include "core/base/text.h"

namespace insula::case_builder {
namespace {

Vec3 direction(const Json& json) { return vec3_from(json).normalized(); }

ApproachView view_of(const Json& json) {
  ApproachView v;
  v.eye = json.at("eye"), v.up = json.at("up"), v.field_of_view = json.at("field_of_view");
  v.target = json.value("target", std::string());
  if (v.target.empty()) v.from_neck = vec3_from(json.at("from_neck_mm"));
  return v;
}

ApproachField field_of(const Json& json) {
  const Json& blood = json.at("blood");
  return {view_of(json.at("view")), json.at("left"),    json.at("right"),
          blood.at("up"),           blood.at("radius"), blood.at("depth")};
}

ApproachOpening opening_of(const Json& json) {
  ApproachOpening o;
  o.file = json.at("file"), o.motion = json.value("motion", std::string());
  o.id = json.at("id"), o.comment = json.at("comment"), o.scene = json.at("scene");
  o.title = json.at("title"), o.text = json.at("text");
  o.view = view_of(json.at("view"));
  o.left = json.at("left"), o.right = json.at("right");
  o.strands_centre = json.at("strands").at("centre"), o.strands_radius = json.at("strands").at("radius");
  o.opens_at = json.at("opens_at"), o.inward = json.at("inward");
  return o;
}

Approach approach_of(const Json& json, const fs::path& folder) {
  Approach a;
  a.folder = folder;
  a.name = json.at("name"), a.title = json.at("title");
  const Json& field = json.at("field");
  a.centre = vec3_from(field.at("centre_mm")), a.radius = field.at("radius_mm"), a.held = field.at("held_mm");
  a.lobes = {json.at("lobes").at(0), json.at("lobes").at(1)};
  a.floor = json.at("floor"), a.obstacles = json.at("obstacles").get<std::vector<std::string>>();
  const Json& aneurysm = json.at("aneurysm");
  a.neck = vec3_from(aneurysm.at("neck_mm"));
  a.sac_points = direction(aneurysm.at("sac_points")), a.parent_arrives = direction(aneurysm.at("parent_arrives"));
  a.to_surgeon = direction(json.at("to_surgeon"));
  const Json& parts = json.at("parts");
  a.closed_part = parts.at("closed"), a.open_part = parts.at("open"), a.limits_part = parts.at("limits");
  a.more_parts = parts.value("more", std::vector<std::string>());
  a.rigid_folders = json.at("rigid_folders").get<std::vector<std::string>>();
  if (json.contains("opening")) a.opening = opening_of(json["opening"]);
  a.dissection = field_of(json.at("dissection")), a.clipping = field_of(json.at("clipping"));
  const Json& suction = json.at("suction");
  a.suction_shaft = direction(suction.at("shaft")), a.suction_flat = vec3_from(suction.at("flat"));
  a.suction_beside_neck = vec3_from(suction.at("beside_neck_mm"));
  return a;
}

}  // namespace

Approach read_approach(const fs::path& project, const std::string& name) {
  std::vector<std::string> names;
  for (const auto& entry : fs::directory_iterator(project / "meshes")) {
    const fs::path file = entry.path() / "approach.json";
    if (!fs::exists(file)) continue;
    const Json json = read_json(file);
    try {
      names.push_back(json.at("name"));
      if (names.back() == name) return approach_of(json, entry.path());
    } catch (const nlohmann::json::exception& e) {
      throw InputError(file.string() + ": is no approach: " + e.what());
    }
  }
  std::sort(names.begin(), names.end());
  std::string known;
  for (const std::string& n : names) known += (known.empty() ? "" : ", ") + n;
  throw InputError("there is no approach " + in_quotes(name) + "; there are: " + known);
}

}  // namespace insula::case_builder
