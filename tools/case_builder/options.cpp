// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/case_builder/options.h"

#include "core/base/input_error.h"

namespace insula::case_builder {
namespace {

template <class T>
void put(Json& json, const char* name, const std::optional<T>& value) {
  if (value) json[name] = *value;
}
template <class T>
void take(const Json& json, const char* name, std::optional<T>& value) {
  if (json.contains(name)) value = json[name].get<T>();
}
template <class T>
void take(const Json& json, const char* name, T& value) {
  if (json.contains(name)) value = json[name].get<T>();
}

Json strokes_json(const std::vector<Stroke>& strokes) {
  Json out = Json::array();
  for (const Stroke& s : strokes) out.push_back({{"erase", s.erase}, {"radius_mm", s.radius_mm}, {"points", s.points}});
  return out;
}

Json wall_patches_json(const std::vector<WallPatch>& patches) {
  Json out = Json::array();
  for (const WallPatch& p : patches) {
    Json one = {{"points", p.points}, {"radius_mm", p.radius_mm}};
    if (!p.thickness.empty()) one["thickness"] = p.thickness;
    if (!p.young.empty()) one["young"] = p.young;
    out.push_back(one);
  }
  return out;
}

std::vector<WallPatch> wall_patches_from_json(const Json& json) {
  std::vector<WallPatch> out;
  for (const Json& p : json)
    out.push_back({p.at("points").get<std::vector<Point>>(), p.at("radius_mm"), p.value("thickness", std::string()),
                   p.value("young", std::string())});
  return out;
}

Json retractors_json(const std::vector<RetractorChoice>& retractors) {
  Json out = Json::array();
  for (const RetractorChoice& r : retractors) {
    Json one = {{"lobe", r.lobe}, {"tip_mm", r.tip}};
    put(one, "shaft", r.shaft);
    put(one, "flat", r.flat);
    put(one, "pull_mm", r.pull);
    out.push_back(one);
  }
  return out;
}

std::vector<RetractorChoice> retractors_from_options(const Json& json) {
  std::vector<RetractorChoice> out;
  for (const Json& one : json) {
    RetractorChoice r{one.at("lobe"), one.at("tip_mm").get<Point>(), {}, {}, {}};
    take(one, "shaft", r.shaft);
    take(one, "flat", r.flat);
    take(one, "pull_mm", r.pull);
    out.push_back(std::move(r));
  }
  return out;
}

}  // namespace

std::vector<Stroke> strokes_from_json(const Json& json) {
  std::vector<Stroke> out;
  for (const Json& s : json.get<std::vector<Json>>())
    out.push_back({s.at("erase"), s.at("radius_mm"), s.at("points").get<std::vector<Point>>()});
  return out;
}

Json to_json(const Options& o) {
  Json j = Json::object();
  put(j, "unit_mm", o.unit_mm);
  if (o.mirror) j["mirror"] = true;
  j["any_size"] = o.any_size;
  put(j, "threshold", o.threshold);
  put(j, "label", o.label);
  put(j, "seed", o.seed);
  put(j, "around", o.around);
  if (!o.paint.empty()) j["paint"] = strokes_json(o.paint);
  j["keep_largest"] = o.keep_largest;
  put(j, "rebuild", o.rebuild);
  j["cuts"] = o.cuts;
  j["smoothing"] = o.smoothing;
  put(j, "neck", o.neck);
  put(j, "neck_points", o.neck_points);
  put(j, "inlet", o.inlet);
  j["keep"] = o.keep;
  j["vertices"] = o.vertices;
  if (o.keep_vertices) j["keep_vertices"] = true;
  put(j, "coarser_vertices", o.coarser);
  j["bleb"] = o.bleb;
  if (!o.walls.empty()) j["walls"] = o.walls;
  if (!o.wall_patches.empty()) j["wall_patches"] = wall_patches_json(o.wall_patches);
  if (!o.brain.empty()) {
    j["brain"] = o.brain;
    j["lobe_labels"] = o.lobe_labels;
    put(j, "brain_unit_mm", o.brain_unit_mm);
    j["brain_in_place"] = o.brain_in_place;
    j["brain_nodes"] = o.brain_nodes;
  }
  if (o.approach != Options().approach) j["approach"] = o.approach;
  j["in_place"] = o.in_place;
  j["gap"] = o.gap;
  j["spin"] = o.spin;
  j["keep_spin"] = o.keep_spin;
  put(j, "pose", o.pose);
  if (o.retractors) j["retractors"] = retractors_json(*o.retractors);
  j["lobes"] = o.lobes;
  if (!o.site.empty()) j["site"] = o.site;
  if (o.difficulty > 0) j["difficulty"] = o.difficulty;
  j["clip"] = o.clip;
  put(j, "lift", o.lift);
  put(j, "slide", o.slide);
  put(j, "turn", o.turn);
  if (!o.rules.empty()) j["rules"] = o.rules;
  j["plays"] = o.plays;
  j["rehearse"] = o.rehearse;
  return j;
}

Options options_from_json(const Json& j) {
  Options o;
  try {
    take(j, "unit_mm", o.unit_mm);
    take(j, "mirror", o.mirror);
    take(j, "any_size", o.any_size);
    take(j, "threshold", o.threshold);
    take(j, "label", o.label);
    take(j, "seed", o.seed);
    take(j, "around", o.around);
    if (j.contains("paint")) o.paint = strokes_from_json(j["paint"]);
    take(j, "keep_largest", o.keep_largest);
    take(j, "rebuild", o.rebuild);
    take(j, "cuts", o.cuts);
    take(j, "smoothing", o.smoothing);
    take(j, "neck", o.neck);
    take(j, "neck_points", o.neck_points);
    take(j, "inlet", o.inlet);
    take(j, "keep", o.keep);
    take(j, "vertices", o.vertices);
    o.keep_vertices = o.vertices != Options().vertices;  // of older cases, which do not say it
    take(j, "keep_vertices", o.keep_vertices);
    take(j, "coarser_vertices", o.coarser);
    take(j, "bleb", o.bleb);
    take(j, "walls", o.walls);
    if (j.contains("wall_patches")) o.wall_patches = wall_patches_from_json(j["wall_patches"]);
    take(j, "brain", o.brain);
    take(j, "lobe_labels", o.lobe_labels);
    take(j, "brain_unit_mm", o.brain_unit_mm);
    take(j, "brain_in_place", o.brain_in_place);
    take(j, "brain_nodes", o.brain_nodes);
    take(j, "approach", o.approach);
    take(j, "in_place", o.in_place);
    take(j, "gap", o.gap);
    take(j, "spin", o.spin);
    take(j, "keep_spin", o.keep_spin);
    take(j, "pose", o.pose);
    if (j.contains("retractors")) o.retractors = retractors_from_options(j["retractors"]);
    take(j, "lobes", o.lobes);
    take(j, "site", o.site);
    take(j, "difficulty", o.difficulty);
    take(j, "clip", o.clip);
    take(j, "lift", o.lift);
    take(j, "slide", o.slide);
    take(j, "turn", o.turn);
    take(j, "rules", o.rules);
    take(j, "plays", o.plays);
    take(j, "rehearse", o.rehearse);
  } catch (const nlohmann::json::exception& e) {
    throw InputError(std::string("case.json: an option has the wrong kind of value: ") + e.what());
  }
  return o;
}

}  // namespace insula::case_builder
