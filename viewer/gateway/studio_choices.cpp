// SPDX-License-Identifier: GPL-3.0-or-later
#include "viewer/gateway/studio_choices.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <map>

#include "core/base/input_error.h"

namespace insula::gateway {
namespace {

using Json = nlohmann::json;

constexpr double far_away = 1e6;  // mm
constexpr std::size_t most_cuts = 12;
constexpr std::size_t most_strokes = 100, most_points = 200;
constexpr std::size_t most_changes = 200;
constexpr std::size_t most_patches = 20;
constexpr std::size_t most_retractors = 4;
constexpr double most_pull = 15;  // mm

bool is_number(const Json& v, double least, double most) {
  return v.is_number() && std::isfinite(v.get<double>()) && v.get<double>() >= least && v.get<double>() <= most;
}

bool are_numbers(const Json& v, std::size_t count) {
  return v.is_array() && v.size() == count &&
         std::all_of(v.begin(), v.end(), [](const Json& x) { return is_number(x, -far_away, far_away); });
}

bool is_plane(const Json& v) {
  return are_numbers(v, 6) && std::hypot(v[3].get<double>(), v[4].get<double>(), v[5].get<double>()) > 1e-9;
}

bool is_neck(const Json& v) {
  if (v.is_null()) return true;
  if (!v.is_object() || v.size() != 1) return false;
  return v.contains("plane") ? is_plane(v["plane"]) : v.contains("points") && are_numbers(v["points"], 6);
}

bool are_cuts(const Json& v) {
  return v.is_array() && v.size() <= most_cuts && std::all_of(v.begin(), v.end(), is_plane);
}

bool is_stroke(const Json& v) {
  return v.is_object() && v.size() == 3 && v.contains("erase") && v["erase"].is_boolean() && v.contains("radius_mm") &&
         is_number(v["radius_mm"], 0.1, 20) && v.contains("points") && v["points"].is_array() && !v["points"].empty() &&
         v["points"].size() <= most_points &&
         std::all_of(v["points"].begin(), v["points"].end(), [](const Json& p) { return are_numbers(p, 3); });
}

bool are_strokes(const Json& v) {
  return v.is_array() && v.size() <= most_strokes && std::all_of(v.begin(), v.end(), is_stroke);
}

bool is_one_of(const Json& v, std::initializer_list<const char*> values) {
  return v.is_string() && std::any_of(values.begin(), values.end(), [&](const char* one) { return v == one; });
}

/// "name.parameter=value", on one line.
bool is_change(const Json& v) {
  if (!v.is_string()) return false;
  const std::string& s = v.get_ref<const std::string&>();
  const std::size_t dot = s.find('.');
  return s.size() < 200 && dot != 0 && dot != std::string::npos && s.find('=') != std::string::npos &&
         s.find_first_of("\n\r") == std::string::npos;
}

bool are_changes(const Json& v) {
  return v.is_array() && v.size() <= most_changes && std::all_of(v.begin(), v.end(), is_change);
}

/// As tools/case_builder/rules.h reads changes of a case's rules.
bool are_rule_changes(const Json& v) {
  return are_changes(v) && std::all_of(v.begin(), v.end(), [](const Json& one) {
           const char exercise = one.get_ref<const std::string&>()[0];
           return exercise >= '1' && exercise <= '4' && one.get_ref<const std::string&>()[1] == '.';
         });
}

/// A value with its unit; empty: none. What separates the parts of a patch may not stand in it.
bool is_value(const Json& v) {
  return v.is_string() && v.get_ref<const std::string&>().size() < 40 &&
         v.get_ref<const std::string&>().find_first_of(",;=\n\r") == std::string::npos;
}

bool is_patch(const Json& v) {
  return v.is_object() && v.size() == 4 && v.contains("points") && v["points"].is_array() && !v["points"].empty() &&
         v["points"].size() <= most_points &&
         std::all_of(v["points"].begin(), v["points"].end(), [](const Json& p) { return are_numbers(p, 3); }) &&
         v.contains("radius_mm") && is_number(v["radius_mm"], 0.1, 20) && v.contains("thickness") &&
         is_value(v["thickness"]) && v.contains("young") && is_value(v["young"]);
}

bool are_patches(const Json& v) {
  return v.is_array() && v.size() <= most_patches && std::all_of(v.begin(), v.end(), is_patch);
}

/// Of a clip or a lobe.
bool is_name(const Json& v) {
  return v.is_string() && !v.get_ref<const std::string&>().empty() && v.get_ref<const std::string&>().size() <= 64 &&
         std::all_of(v.get_ref<const std::string&>().begin(), v.get_ref<const std::string&>().end(),
                     [](char c) { return (c >= 'a' && c <= 'z') || (c >= '0' && c <= '9') || c == '_'; });
}

/// As tools/case_builder/retractors.h reads it.
bool is_retractor(const Json& v) {
  const auto is_direction = [](const Json& d) {
    return are_numbers(d, 3) && std::hypot(d[0].get<double>(), d[1].get<double>(), d[2].get<double>()) > 1e-6;
  };
  return v.is_object() && v.size() == 5 && v.contains("lobe") && is_name(v["lobe"]) && v.contains("tip_mm") &&
         are_numbers(v["tip_mm"], 3) && v.contains("shaft") && is_direction(v["shaft"]) && v.contains("flat") &&
         is_direction(v["flat"]) && v.contains("pull_mm") && is_number(v["pull_mm"], 0, most_pull);
}

bool are_retractors(const Json& v) {
  return v.is_null() || (v.is_array() && v.size() <= most_retractors && std::all_of(v.begin(), v.end(), is_retractor));
}

bool is_clip(const Json& v) { return v == "" || is_name(v); }

struct Rule {
  std::function<bool(const Json&)> allows;
  const char* refused;
};

const std::map<std::string, Rule>& rules() {
  const auto is_switch = [](const Json& v) { return v.is_boolean(); };
  const auto whole = [](int least, int most) {
    return [=](const Json& v) { return v.is_number_integer() && is_number(v, least, most); };
  };
  static const std::map<std::string, Rule> all = {
      {"unit",
       {[](const Json& v) {
          return is_one_of(v, {"", "mm", "cm", "m", "um", "inch"});
        },
        "this is no unit of a file"}},
      {"mirror", {is_switch, "the side is left or right"}},
      {"any_size", {is_switch, "sizes are checked, or not"}},
      {"cuts", {are_cuts, "a cut has a point and a direction; there are 12 at most"}},
      {"threshold",
       {[](const Json& v) { return v.is_null() || is_number(v, -far_away, far_away); }, "a threshold is a number"}},
      {"label",
       {[whole](const Json& v) { return v.is_null() || whole(1, 65535)(v); }, "a label is a whole number above 0"}},
      {"seed", {[](const Json& v) { return v.is_null() || are_numbers(v, 3); }, "the seed is a point"}},
      {"around_mm",
       {[](const Json& v) { return v.is_null() || is_number(v, 5, 200); },
        "the part around the seed is from 5 to 200 mm"}},
      {"paint", {are_strokes, "there are 100 strokes at most, each with a radius and 1 to 200 points"}},
      {"neck", {is_neck, "a neck has a point and a direction, or two points"}},
      {"inlet", {[](const Json& v) { return v.is_null() || are_numbers(v, 3); }, "the inlet is a point"}},
      {"rebuild_mm",
       {[](const Json& v) { return v.is_null() || is_number(v, 0.03, 2); }, "the grid is from 0.03 to 2 mm"}},
      {"keep_mm",
       {[](const Json& v) { return is_number(v, 0, 200); }, "the kept length of the vessels is from 0 to 200 mm"}},
      {"vertices", {whole(400, 6000), "a wall has from 400 to 6000 vertices"}},
      {"spin_deg",
       {[](const Json& v) { return v.is_null() || is_number(v, -360, 360); }, "a turn is from -360 to 360 degrees"}},
      {"walls", {are_changes, "a wall is changed by its region, thickness or young, and a value"}},
      {"wall_patches",
       {are_patches,
        "there are 20 painted parts of the wall at most, each with 1 to 200 points, a radius, a thickness "
        "and a stiffness"}},
      {"pose", {[](const Json& v) { return v.is_null() || are_numbers(v, 6); }, "a place has six numbers"}},
      {"retractors",
       {are_retractors,
        "there are 4 retractors at most, each with a lobe, a tip, two directions, and a pull of 0 to 15 mm"}},
      {"rehearse", {is_switch, "the exercises are played, or not"}},
      {"rules", {are_rule_changes, "a goal is changed by its exercise, its name and a value"}},
      {"clip", {is_clip, "this is no clip"}},
      {"lift_mm",
       {[](const Json& v) { return v.is_null() || is_number(v, -10, 10); }, "blades are lifted by -10 to 10 mm"}},
      {"slide_mm",
       {[](const Json& v) { return v.is_null() || is_number(v, -15, 15); }, "blades are moved by -15 to 15 mm"}},
      {"turn_deg",
       {[](const Json& v) { return v.is_null() || is_number(v, -180, 180); }, "a turn is from -180 to 180 degrees"}},
      {"plays", {whole(1, 100), "from 1 to 100 places of the clip can be tried"}},
      {"site",
       {[](const Json& v) { return v.is_string() && v.get_ref<const std::string&>().size() <= 64; },
        "this is no site of an aneurysm"}},
      {"difficulty", {whole(0, 5), "the difficulty is from 1 to 5"}}};
  return all;
}

/// "1.23 4.56 7.89 mm", and a direction behind it.
std::string place(const Json& v, std::size_t first = 0) {
  return fmt::format("{:.3f} {:.3f} {:.3f} mm", v[first].get<double>(), v[first + 1].get<double>(),
                     v[first + 2].get<double>());
}

std::string plane(const Json& v) {
  return fmt::format("{} {:.4f} {:.4f} {:.4f}", place(v), v[3].get<double>(), v[4].get<double>(), v[5].get<double>());
}

/// As tools/case_builder/wall_patches.h reads it.
std::string patch(const Json& v) {
  std::string out;
  for (const Json& point : v["points"]) out += place(point) + ", ";
  out += fmt::format("radius={:g} mm", v["radius_mm"].get<double>());
  for (const char* name : {"thickness", "young"})
    if (v[name] != "") out += fmt::format(", {}={}", name, v[name].get<std::string>());
  return out;
}

std::string direction(const Json& v) {
  return fmt::format("{:.4f} {:.4f} {:.4f}", v[0].get<double>(), v[1].get<double>(), v[2].get<double>());
}

std::string retractor(const Json& v) {
  return fmt::format("{}, {}, shaft={}, flat={}, pull={:g} mm", v["lobe"].get<std::string>(), place(v["tip_mm"]),
                     direction(v["shaft"]), direction(v["flat"]), v["pull_mm"].get<double>());
}

}  // namespace

Json first_choices() {
  return {{"paint", Json::array()},
          {"threshold", nullptr},
          {"label", nullptr},
          {"seed", nullptr},
          {"around_mm", nullptr},
          {"unit", ""},
          {"mirror", false},
          {"any_size", false},
          {"cuts", Json::array()},
          {"neck", nullptr},
          {"inlet", nullptr},
          {"rebuild_mm", nullptr},
          {"keep_mm", 13},
          {"vertices", 1650},
          {"walls", Json::array()},
          {"wall_patches", Json::array()},
          {"spin_deg", nullptr},
          {"pose", nullptr},
          {"retractors", nullptr},
          {"rehearse", true},
          {"plays", 16},
          {"site", ""},
          {"difficulty", 0},
          {"rules", Json::array()},
          {"clip", ""},
          {"lift_mm", nullptr},
          {"slide_mm", nullptr},
          {"turn_deg", nullptr}};
}

Json changed_choices(Json choices, const Json& changes) {
  if (!changes.is_object()) throw InputError("these are no choices");
  for (const auto& [name, value] : changes.items()) {
    const auto rule = rules().find(name);
    if (rule == rules().end()) throw InputError("there is no choice of this name");
    if (!rule->second.allows(value)) throw InputError(rule->second.refused);
    choices[name] = value;
  }
  if (!choices["threshold"].is_null() && !choices["label"].is_null())
    throw InputError("a vessel in a scan has a threshold or a label");
  return choices;
}

std::vector<std::string> intake_words(const Json& c) {
  std::vector<std::string> out;
  if (c["unit"] != "") out.insert(out.end(), {"--unit", c["unit"].get<std::string>()});
  if (!c["threshold"].is_null())
    out.insert(out.end(), {"--threshold", fmt::format("{:.6g}", c["threshold"].get<double>())});
  if (!c["label"].is_null()) out.insert(out.end(), {"--label", std::to_string(c["label"].get<int>())});
  if (!c["seed"].is_null()) out.insert(out.end(), {"--seed", place(c["seed"])});
  if (!c["seed"].is_null() && !c["around_mm"].is_null())
    out.insert(out.end(), {"--around", fmt::format("{:g} mm", c["around_mm"].get<double>())});
  if (!c["paint"].empty()) out.insert(out.end(), {"--paint", paint_file});
  if (c["mirror"] == true) out.emplace_back("--mirror");
  if (c["any_size"] == true) out.emplace_back("--any-size");
  if (!c["rebuild_mm"].is_null())
    out.insert(out.end(), {"--rebuild", fmt::format("{:g} mm", c["rebuild_mm"].get<double>())});
  for (const Json& cut : c["cuts"]) out.insert(out.end(), {"--cut", plane(cut)});
  return out;
}

std::string pose_words(const Json& v) {
  return fmt::format("{} {:.3f} {:.3f} {:.3f} deg", place(v), v[3].get<double>(), v[4].get<double>(),
                     v[5].get<double>());
}

std::vector<std::string> clip_words(const Json& c) {
  std::vector<std::string> out;
  if (c["clip"] != "") out.insert(out.end(), {"--clip", c["clip"].get<std::string>()});
  const auto add = [&](const char* option, const char* name, const char* unit) {
    if (!c[name].is_null()) out.insert(out.end(), {option, fmt::format("{:g} {}", c[name].get<double>(), unit)});
  };
  add("--lift", "lift_mm", "mm"), add("--slide", "slide_mm", "mm"), add("--turn", "turn_deg", "deg");
  return out;
}

std::vector<std::string> case_words(const Json& c) {
  std::vector<std::string> out = intake_words(c);
  const Json before = first_choices();
  const auto add = [&](const char* option, const std::string& value) { out.insert(out.end(), {option, value}); };
  if (const Json& neck = c["neck"]; neck.is_object()) {
    if (neck.contains("plane")) add("--neck", plane(neck["plane"]));
    else add("--neck-points", place(neck["points"]) + " " + place(neck["points"], 3));
  }
  if (!c["inlet"].is_null()) add("--inlet", place(c["inlet"]));
  if (c["keep_mm"] != before["keep_mm"]) add("--keep", fmt::format("{:g} mm", c["keep_mm"].get<double>()));
  if (c["vertices"] != before["vertices"]) add("--vertices", std::to_string(c["vertices"].get<int>()));
  for (const Json& change : c["walls"]) add("--wall", change.get<std::string>());
  for (const Json& painted : c["wall_patches"])
    if (painted["thickness"] != "" || painted["young"] != "") add("--wall-patch", patch(painted));
  if (!c["pose"].is_null()) add("--pose", pose_words(c["pose"]));
  if (const Json& all = c["retractors"]; all.is_array()) {
    if (all.empty()) out.emplace_back("--no-retractors");
    for (const Json& one : all) add("--retractor", retractor(one));
  }
  if (!c["spin_deg"].is_null()) add("--spin", fmt::format("{:g} deg", c["spin_deg"].get<double>()));
  if (c["rehearse"] == false) out.emplace_back("--no-rehearse");
  if (c["plays"] != before["plays"]) add("--plays", std::to_string(c["plays"].get<int>()));
  if (c["site"] != "") add("--site", c["site"].get<std::string>());
  if (c["difficulty"] != 0) add("--difficulty", std::to_string(c["difficulty"].get<int>()));
  const std::vector<std::string> clip = clip_words(c);
  out.insert(out.end(), clip.begin(), clip.end());
  for (const Json& change : c["rules"]) add("--rule", change.get<std::string>());
  return out;
}

}  // namespace insula::gateway
