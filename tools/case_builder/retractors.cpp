// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/case_builder/retractors.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "core/base/input_error.h"
#include "core/base/text.h"
#include "core/params/number.h"
#include "tools/case_builder/assignment.h"
#include "tools/case_builder/topology.h"
#include "tools/case_builder/unit_options.h"

namespace insula::case_builder {
namespace {

constexpr double least_across = 0.17;  // sine of the angle between shaft and flat side
constexpr const char* form = "write \"LOBE, X Y Z mm, shaft=X Y Z, flat=X Y Z, pull=5 mm\"";

[[noreturn]] void refuse_retractor(const std::string& text, const std::string& why) {
  throw InputError("--retractor " + text + ": " + why);
}

Point direction(const std::string& name, const std::string& value, const std::string& text) {
  const auto words = split_blanks(value);
  Point out{};
  std::string why;
  if (words.size() != 3) refuse_retractor(text, name + " is a direction: three numbers without a unit");
  for (std::size_t k = 0; k < 3; ++k) {
    const auto number = read_number(words[k], why);
    if (!number) refuse_retractor(text, name + ": " + why);
    out[k] = *number;
  }
  if (std::hypot(out[0], out[1], out[2]) < 1e-6) refuse_retractor(text, name + ": a direction must not be zero");
  return out;
}

double pull(const std::string& value, const std::string& text) {
  const std::string most = fmt::format("{:g} mm", most_pull);
  const QuantityOption option{.bare = "mm", .min = "0 mm", .max = most, .doc = {}};
  std::string why;
  const auto mm = read_with_unit(value, Length::units(), Length::name, option, why);
  if (!mm) refuse_retractor(text, "pull: " + why);
  return *mm;
}

void take_value(RetractorChoice& out, const Assignment& given, const std::string& text) {
  const auto& [name, value] = given;
  if (name == "shaft") out.shaft = direction(name, value, text);
  else if (name == "flat") out.flat = direction(name, value, text);
  else if (name == "pull") out.pull = pull(value, text);
  else refuse_retractor(text, "a retractor has no " + in_quotes(name) + "; it has shaft, flat and pull");
}

Vec3 as_vector(const Point& p) { return {p[0], p[1], p[2]}; }

/// What an author calls it.
std::string named(std::size_t k, const RetractorAt& r) { return fmt::format("Retractor {} ({} lobe)", k + 1, r.lobe); }

void check_place(const std::string& name, const RetractorAt& r, const Approach& a) {
  if (const double away = (r.tip - a.centre).norm(); away > a.radius)
    throw InputError(
        fmt::format("{}: its tip lies {:.0f} mm from the middle of the fissure, outside of the lobes. Move it to "
                    "within {:.0f} mm of ({:g}, {:g}, {:g})",
                    name, away, a.radius, a.centre.x(), a.centre.y(), a.centre.z()));
  const double lean = std::acos(std::clamp(r.shaft.dot(a.to_surgeon), -1.0, 1.0)) * 180 / std::numbers::pi;
  if (lean > most_lean)
    throw InputError(
        fmt::format("{}: its shaft leans {:.0f} degrees off the line of sight, and no arm could hold it there. Lean it "
                    "by {:.0f} degrees at most",
                    name, lean, most_lean));
}

/// The flat side across the shaft.
void square(const std::string& name, RetractorAt& r) {
  r.shaft.normalize(), r.flat.normalize();
  const Vec3 across = r.flat - r.flat.dot(r.shaft) * r.shaft;
  if (across.norm() < least_across)
    throw InputError(name + ": its flat side faces along its shaft. Turn it to face the lobe");
  r.flat = across.normalized();
}

}  // namespace

RetractorChoice read_retractor(const std::string& text) {
  RetractorChoice out;
  bool has_tip = false;
  std::size_t at = 0;
  for (int part_number = 0; at <= text.size(); ++part_number) {
    const std::size_t end = std::min(text.find(',', at), text.size());
    const std::string part(trim(std::string_view(text).substr(at, end - at)));
    at = end + 1;
    if (const auto value = read_assignment(part)) {
      take_value(out, *value, text);
    } else if (part_number == 0) {
      out.lobe = part;
    } else {
      std::string why;
      const auto numbers = read_shape(part, Shape::point, why);
      if (!numbers) refuse_retractor(text, why);
      if (has_tip) refuse_retractor(text, "it has two tips");
      has_tip = true;
      std::copy(numbers->begin(), numbers->end(), out.tip.begin());
    }
  }
  if (out.lobe.empty() || number_length(out.lobe) > 0) refuse_retractor(text, std::string("it names no lobe; ") + form);
  if (!has_tip) refuse_retractor(text, std::string("it has no tip; ") + form);
  return out;
}

std::vector<RetractorAt> chosen_retractors(const std::vector<RetractorChoice>& choices,
                                           const std::vector<RetractorAt>& proposed, const Approach& approach) {
  if (choices.size() > most_retractors)
    throw InputError(
        fmt::format("there are {} retractors; the arms have room for {}", choices.size(), most_retractors));
  std::vector<RetractorAt> out;
  for (const RetractorChoice& c : choices) {
    RetractorAt r;
    r.lobe = c.lobe, r.tip = as_vector(c.tip);
    const std::string name = named(out.size(), r);
    if (std::find(approach.lobes.begin(), approach.lobes.end(), r.lobe) == approach.lobes.end())
      throw InputError(name + ": there is no such lobe here. The lobes are " + approach.lobes[0] + " and " +
                       approach.lobes[1]);
    const auto like =
        std::find_if(proposed.begin(), proposed.end(), [&](const RetractorAt& p) { return p.lobe == r.lobe; });
    if (like == proposed.end() && !(c.shaft && c.flat && c.pull))
      throw InputError(name + ": none is proposed for this lobe, so shaft, flat and pull must be given");
    r.shaft = c.shaft ? as_vector(*c.shaft) : like->shaft;
    r.flat = c.flat ? as_vector(*c.flat) : like->flat;
    r.pull = c.pull ? *c.pull : like->pull;
    square(name, r);
    check_place(name, r, approach);
    out.push_back(std::move(r));
  }
  return out;
}

TriMesh at_place(const TriMesh& blade, const RetractorAt& r) {
  Mat3 turn;
  turn << r.flat, r.shaft.cross(r.flat), r.shaft;
  TriMesh out = blade;
  for (Vec3& p : out.vertices) p = turn * p + r.tip;
  return out;
}

TriMesh at_places(const TriMesh& blade, const std::vector<RetractorAt>& retractors) {
  TriMesh out;
  for (const RetractorAt& r : retractors) append(out, at_place(blade, r));
  return out;
}

Json to_json(const std::vector<RetractorAt>& retractors) {
  Json out = Json::array();
  for (const RetractorAt& r : retractors)
    out.push_back({{"lobe", r.lobe},
                   {"tip_mm", to_json(r.tip)},
                   {"shaft", to_json(r.shaft)},
                   {"flat", to_json(r.flat)},
                   {"pull_mm", rounded(r.pull)}});
  return out;
}

std::vector<RetractorAt> retractors_from(const Json& json) {
  std::vector<RetractorAt> out;
  for (const Json& r : json)
    out.push_back(
        {r.at("lobe"), vec3_from(r.at("tip_mm")), vec3_from(r.at("shaft")), vec3_from(r.at("flat")), r.at("pull_mm")});
  return out;
}

}  // namespace insula::case_builder
