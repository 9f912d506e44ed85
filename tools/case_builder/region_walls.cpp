// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/case_builder/region_walls.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "core/base/diagnostic.h"
#include "core/base/input_error.h"
#include "tools/case_builder/assignment.h"
#include "tools/case_builder/declarations.h"

namespace insula::case_builder {
namespace {

constexpr const char* all_vessels = "vessels";

bool is_vessel(const std::string& region) { return region != "neck" && region != "sac" && region != "bleb"; }

std::vector<WallOf> proposed(const artery::Vessel& v) {
  std::vector<WallOf> out;
  std::string vessels;
  for (const std::string& r : v.regions)
    if (is_vessel(r)) vessels += (vessels.empty() ? "" : " ") + r;
  out.push_back({vessels, 0.3, 1.5});
  // A thin sphere changes its volume by 3 (1 - nu) dP r / (2 E t): the same share for all sizes asks for E in
  // proportion to r.
  const auto at = v.dimensions.find("sac_width");
  const double radius = at == v.dimensions.end() ? 2.8 : 0.5 * std::max(at->second, v.neck ? v.neck->diameter : 0.0);
  const double young = std::clamp(std::round(100 * 1.05 * radius / 2.8) / 100, 0.6, 4.0);
  for (const std::string& r : v.regions) {
    if (r == "neck") out.push_back({r, 0.25, std::max(1.2, young)});
    if (r == "sac") out.push_back({r, 0.2, young});
    if (r == "bleb") out.push_back({r, 0.1, young});
  }
  return out;
}

[[noreturn]] void refuse(const std::string& text, const std::string& why) {
  throw InputError("--wall " + text + ": " + why);
}

void apply(WallOf& wall, const WallChange& c, const std::string& text) {
  if (c.parameter == "thickness") wall.thickness_mm = 1e3 * wall_value(c.parameter, c.value, "--wall " + text);
  else wall.young_mpa = 1e-6 * wall_value(c.parameter, c.value, "--wall " + text);
}

/// The wall of one region alone, which leaves the others that it was declared with.
WallOf& wall_alone(std::vector<WallOf>& walls, const std::string& region, const std::string& text) {
  std::vector<std::string> names{all_vessels};
  for (std::size_t k = 0; k < walls.size(); ++k) {
    std::string others;
    bool here = false;
    std::size_t count = 0;
    for (std::size_t at = 0, end; at < walls[k].regions.size(); at = end + 1) {
      end = std::min(walls[k].regions.find(' ', at), walls[k].regions.size());
      const std::string one = walls[k].regions.substr(at, end - at);
      names.push_back(one), ++count;
      if (one == region) here = true;
      else others += (others.empty() ? "" : " ") + one;
    }
    if (!here) continue;
    if (count == 1) return walls[k];
    walls[k].regions = others;
    return *walls.insert(walls.begin() + long(k) + 1, {region, walls[k].thickness_mm, walls[k].young_mpa});
  }
  std::string list;
  for (const std::string& n : names) list += (list.empty() ? "" : ", ") + n;
  refuse(text, "the vessel has no region \"" + region + "\"" + did_you_mean(nearest_name(region, names)) + "; it has " +
                   list);
}

}  // namespace

double wall_value(const std::string& name, const std::string& value, const std::string& given) {
  const auto membrane = builtin_registry().find("membrane")->create();
  auto* parameter = dynamic_cast<QuantityParam*>(membrane->find_param(name));
  if (!parameter) throw std::logic_error("<membrane> declares no " + name);
  if (const std::string why = parameter->assign(value, {}); !why.empty()) throw InputError(given + ": " + why);
  return (*parameter)();
}

WallChange read_wall_change(const std::string& text) {
  const auto given = read_assignment(text);
  const std::size_t dot = given ? given->name.find('.') : std::string::npos;
  if (dot == std::string::npos || dot == 0) refuse(text, "write REGION.PARAMETER=VALUE, such as neck.young=7 MPa");
  WallChange c{given->name.substr(0, dot), given->name.substr(dot + 1), given->value};
  if (c.parameter != "thickness" && c.parameter != "young")
    refuse(text, "a wall has no \"" + c.parameter + "\"; it has thickness and young");
  WallOf checked{};
  apply(checked, c, text);
  return c;
}

std::vector<WallOf> walls_of(const artery::Vessel& v, const Options& o) {
  std::vector<WallOf> out = proposed(v);
  for (const std::string& text : o.walls) {
    const WallChange c = read_wall_change(text);
    if (c.region != all_vessels) {
      apply(wall_alone(out, c.region, text), c, text);
      continue;
    }
    for (WallOf& wall : out)
      if (is_vessel(wall.regions)) apply(wall, c, text);
  }
  return out;
}

Json to_json(const std::vector<WallOf>& walls) {
  Json out = Json::array();
  for (const WallOf& w : walls)
    out.push_back({{"regions", w.regions}, {"thickness_mm", w.thickness_mm}, {"young_MPa", w.young_mpa}});
  return out;
}

std::vector<WallOf> walls_from(const Json& json) {
  std::vector<WallOf> out;
  for (const Json& w : json) out.push_back({w.at("regions"), w.at("thickness_mm"), w.at("young_MPa")});
  return out;
}

}  // namespace insula::case_builder
