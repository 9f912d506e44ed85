// SPDX-License-Identifier: GPL-3.0-or-later
// Reads vessel.json and checks everything in it.
#include "core/model/vessel_model.h"

#include <algorithm>
#include <cmath>
#include <fstream>
#include <map>
#include <nlohmann/json.hpp>
#include <set>

#include "core/base/text.h"
#include "core/model/file_bytes.h"

namespace insula {
namespace {

using Json = nlohmann::json;
constexpr std::uintmax_t largest_json = 64u << 20;

class VesselReader {
 public:
  explicit VesselReader(const std::filesystem::path& file) : file_(file) {}

  VesselModel read() {
    const Json json = parse();
    try {
      fill(json);
    } catch (const Json::exception& e) {
      fail(file_, std::string("is not a vessel: ") + e.what());
    }
    return std::move(vessel_);
  }

 private:
  Json parse() const {
    std::error_code error;
    const auto size = std::filesystem::file_size(file_, error);
    if (error) fail(file_, "cannot be read");
    if (size > largest_json) fail(file_, "is too large for a vessel");
    std::ifstream in(file_);
    if (!in) fail(file_, "cannot be read");
    Json json = Json::parse(in, nullptr, false);
    if (json.is_discarded()) fail(file_, "is no valid JSON");
    return json;
  }

  double number(const Json& j, const std::string& what) const {
    const double v = j.get<double>();
    if (!std::isfinite(v)) fail(file_, what + " is not finite");
    return v;
  }
  double length(const Json& j, const std::string& what) const {
    const double v = number(j, what);
    if (!(v > 0)) fail(file_, what + " must be positive");
    return v * unit_;
  }
  Vec3 vector(const Json& j, const std::string& what) const {
    if (!j.is_array() || j.size() != 3) fail(file_, what + " must have three numbers");
    return {number(j[0], what), number(j[1], what), number(j[2], what)};
  }

  void fill(const Json& j) {
    const std::string unit = j.at("unit").get<std::string>();
    if (unit == "mm") unit_ = 1e-3;
    else if (unit == "m") unit_ = 1;
    else fail(file_, "unit " + in_quotes(unit) + " is not known; use mm or m");
    vessel_.wall = read_surface(file_.parent_path() / "wall.ply", unit_);
    closed();
    regions(j);
    caps(j);
    centrelines(j);
    aneurysm(j);
  }

  void closed() const {
    std::map<std::pair<int, int>, int> edges;
    for (const auto& t : vessel_.wall.triangles)
      for (int k = 0; k < 3; ++k) ++edges[{t[std::size_t(k)], t[std::size_t((k + 1) % 3)]}];
    for (const auto& [e, n] : edges) {
      const auto back = edges.find({e.second, e.first});
      if (n != 1 || back == edges.end() || back->second != 1)
        fail(file_, "its wall is not closed at the edge between vertices " + std::to_string(e.first) + " and " + std::to_string(e.second));
    }
  }

  void regions(const Json& j) {
    std::set<std::string> seen;
    for (const Json& name : j.at("regions")) {
      vessel_.regions.push_back(name.get<std::string>());
      if (vessel_.regions.back().empty() || !seen.insert(vessel_.regions.back()).second)
        fail(file_, "region " + in_quotes(vessel_.regions.back()) + " is named twice or not at all");
    }
    const Json& of = j.at("vertex_region");
    if (!of.is_array() || of.size() != vessel_.wall.vertices.size())
      fail(file_, "vertex_region has " + std::to_string(of.size()) + " entries for " + std::to_string(vessel_.wall.vertices.size()) + " vertices");
    for (const Json& r : of) {
      const long k = r.is_number_integer() ? r.get<long>() : -1;
      if (k < 0 || k >= long(vessel_.regions.size())) fail(file_, "vertex_region names a region that is not there");
      vessel_.vertex_region.push_back(int(k));
    }
  }

  void caps(const Json& j) {
    std::set<std::string> names;
    std::set<int> used;
    for (const Json& c : j.at("caps")) {
      VesselModel::Cap cap;
      cap.name = c.at("name").get<std::string>();
      if (cap.name.empty() || !names.insert(cap.name).second) fail(file_, "cap " + in_quotes(cap.name) + " is named twice or not at all");
      for (const Json& t : c.at("triangles")) {
        const long k = t.is_number_integer() ? t.get<long>() : -1;
        if (k < 0 || k >= long(vessel_.wall.triangles.size())) fail(file_, "cap " + in_quotes(cap.name) + ": a triangle is not there");
        if (!used.insert(int(k)).second) fail(file_, "cap " + in_quotes(cap.name) + ": triangle " + std::to_string(k) + " is in a cap already");
        cap.triangles.push_back(int(k));
      }
      if (cap.triangles.empty()) fail(file_, "cap " + in_quotes(cap.name) + " has no triangles");
      vessel_.caps.push_back(std::move(cap));
    }
  }

  void centrelines(const Json& j) {
    std::set<std::string> names;
    for (const Json& c : j.at("centrelines")) {
      VesselModel::Centreline line;
      line.name = c.at("name").get<std::string>();
      line.region = c.at("region").get<std::string>();
      line.from = c.at("from").get<std::string>();
      line.to = c.at("to").get<std::string>();
      const std::string what = "centreline " + in_quotes(line.name);
      if (line.name.empty() || !names.insert(line.name).second) fail(file_, what + " is named twice or not at all");
      if (std::find(vessel_.regions.begin(), vessel_.regions.end(), line.region) == vessel_.regions.end())
        fail(file_, what + ": its region " + in_quotes(line.region) + " is not there");
      if (line.from.empty() || line.to.empty() || line.from == line.to) fail(file_, what + " must lead from one place to another");
      for (const Json& p : c.at("points")) line.points.push_back(unit_ * vector(p, what));
      for (const Json& r : c.at("radius")) line.radius.push_back(length(r, what + ": a radius"));
      if (line.points.size() < 2 || line.points.size() != line.radius.size())
        fail(file_, what + " has " + std::to_string(line.points.size()) + " points and " + std::to_string(line.radius.size()) + " radii");
      for (std::size_t i = 1; i < line.points.size(); ++i)
        if (!((line.points[i] - line.points[i - 1]).norm() > 1e-9)) fail(file_, what + " has a point twice");
      vessel_.centrelines.push_back(std::move(line));
    }
  }

  void aneurysm(const Json& j) {
    if (j.contains("neck")) {
      const Json& n = j.at("neck");
      vessel_.neck_centre = unit_ * vector(n.at("centre"), "neck centre");
      vessel_.neck_normal = vector(n.at("normal"), "neck normal");
      if (!(vessel_.neck_normal.norm() > 1e-9)) fail(file_, "neck normal must not be zero");
      vessel_.neck_normal.normalize();
      vessel_.neck_diameter = length(n.at("diameter"), "neck diameter");
    }
    if (j.contains("dome_height")) vessel_.dome_height = length(j.at("dome_height"), "dome_height");
    if (j.contains("bleb")) {
      vessel_.bleb_centre = unit_ * vector(j.at("bleb").at("centre"), "bleb centre");
      vessel_.bleb_radius = length(j.at("bleb").at("radius"), "bleb radius");
    }
  }

  std::filesystem::path file_;
  double unit_ = 1e-3;
  VesselModel vessel_;
};

}  // namespace

VesselModel read_vessel(const std::filesystem::path& json) { return VesselReader(json).read(); }

}  // namespace insula
