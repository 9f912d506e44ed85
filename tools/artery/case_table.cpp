// SPDX-License-Identifier: GPL-3.0-or-later
// Reads the table of dimensions.
#include "case_table.h"

#include <cmath>
#include <nlohmann/json.hpp>
#include <numbers>
#include <set>

#include "core/base/text.h"
#include "core/model/formats/file_bytes.h"

namespace insula::artery {
namespace {

using Json = nlohmann::json;

class TableReader {
 public:
  explicit TableReader(const std::filesystem::path& file) : file_(file) {}

  std::vector<CaseSpec> read() {
    Json json;
    try {
      json = Json::parse(read_file_bytes(file_, 1u << 20));
    } catch (const Json::exception& e) {
      fail(file_, "is no valid JSON: " + shown(e.what()));
    }
    const Json& list = member(json, "cases", "");
    if (!list.is_array() || list.empty()) fail(file_, "cases must be a list of one or more");
    std::vector<CaseSpec> cases;
    std::set<std::string> names;
    for (const Json& entry : list) {
      cases.push_back(one(entry));
      if (!names.insert(cases.back().name).second) fail(file_, "two cases are called " + in_quotes(cases.back().name));
    }
    return cases;
  }

 private:
  const Json& member(const Json& json, const char* key, const std::string& where) const {
    if (!json.is_object() || !json.contains(key)) fail(file_, where + key + " is missing");
    return json[key];
  }
  double number(const Json& json, const std::string& what, double low, double high) const {
    if (!json.is_number()) fail(file_, what + " must be a number");
    const double v = json.get<double>();
    if (!(v >= low && v <= high))
      fail(file_, what + " must lie between " + shown(Json(low).dump()) + " and " + shown(Json(high).dump()));
    return v;
  }
  Vec3 vector(const Json& json, const std::string& what) const {
    if (!json.is_array() || json.size() != 3) fail(file_, what + " must be three numbers");
    return {number(json[0], what, -1e3, 1e3), number(json[1], what, -1e3, 1e3), number(json[2], what, -1e3, 1e3)};
  }
  Vec3 direction(const Json& json, const std::string& what) const {
    const Vec3 v = vector(json, what);
    if (!(v.norm() > 1e-6)) fail(file_, what + " has no direction");
    return v.normalized();
  }
  VesselSpec vessel(const Json& json, const std::string& what) const {
    VesselSpec out;
    const Json& diameter = member(json, "diameter", what + ".");
    if (!diameter.is_array() || diameter.size() != 2) fail(file_, what + ".diameter must be two numbers");
    out.first_diameter = number(diameter[0], what + ".diameter", 0.5, 10);
    out.last_diameter = number(diameter[1], what + ".diameter", 0.5, 10);
    const Json& points = member(json, "points", what + ".");
    if (!points.is_array() || points.size() < 3 || points.size() > 100)
      fail(file_, what + ".points must be three to a hundred points");
    for (const Json& p : points) {
      out.points.push_back(vector(p, what + ".points"));
      if (out.points.size() > 1 && !((out.points.back() - out.points[out.points.size() - 2]).norm() > 0.2))
        fail(file_, what + ".points: two neighbours are less than 0.2 mm apart");
    }
    return out;
  }

  CaseSpec one(const Json& json) const {
    CaseSpec c;
    const Json& name = member(json, "name", "a case's ");
    if (!name.is_string()) fail(file_, "a case's name must be text");
    c.name = name.get<std::string>();
    if (c.name.empty() || c.name.find_first_not_of("abcdefghijklmnopqrstuvwxyz0123456789_") != std::string::npos)
      fail(file_, "the case name " + in_quotes(c.name) + " must be made of a-z, 0-9 and _");
    const std::string at = c.name + ": ";
    if (json.contains("about") && json["about"].is_string()) c.about = json["about"].get<std::string>();
    c.parent = vessel(member(json, "parent", at), at + "parent");
    c.superior = vessel(member(json, "superior", at), at + "superior");
    c.inferior = vessel(member(json, "inferior", at), at + "inferior");
    const Vec3 fork = c.parent.points.back();
    if (c.superior.points.front() != fork || c.inferior.points.front() != fork)
      fail(file_, at + "the branches must start where the parent ends");
    const Json& sac = member(json, "sac", at);
    c.neck = number(member(sac, "neck", at + "sac."), at + "sac.neck", 1, 12);
    c.dome_height = number(member(sac, "dome_height", at + "sac."), at + "sac.dome_height", 1, 25);
    c.width = number(member(sac, "width", at + "sac."), at + "sac.width", 1, 25);
    if (!(c.width > 1.02 * c.neck)) fail(file_, at + "sac.width must exceed sac.neck by 2 % or more");
    c.projection = direction(member(sac, "projection", at + "sac."), at + "sac.projection");
    const Json& bleb = member(json, "bleb", at);
    c.bleb_diameter = number(member(bleb, "diameter", at + "bleb."), at + "bleb.diameter", 0.5, 6);
    c.bleb_tilt = number(member(bleb, "tilt_deg", at + "bleb."), at + "bleb.tilt_deg", 0, 90) * std::numbers::pi / 180;
    c.bleb_towards = direction(member(bleb, "towards", at + "bleb."), at + "bleb.towards");
    if (!(c.bleb_towards.cross(c.projection).norm() > 0.1))
      fail(file_, at + "bleb.towards must lie across the projection");
    return c;
  }

  std::filesystem::path file_;
};

}  // namespace

std::vector<CaseSpec> read_case_table(const std::filesystem::path& file) { return TableReader(file).read(); }

}  // namespace insula::artery
