// SPDX-License-Identifier: GPL-3.0-or-later
// Writes wall.ply, picture.ply and vessel.json.
#include <bit>
#include <cmath>
#include <cstdint>
#include <fstream>
#include <nlohmann/json.hpp>

#include "vessel.h"

namespace insula::artery {
namespace {

using Json = nlohmann::ordered_json;
static_assert(std::endian::native == std::endian::little, "binary files are written as they lie in memory");

void write_bytes(const std::filesystem::path& file, const std::string& bytes) {
  std::ofstream out(file, std::ios::binary);
  out.write(bytes.data(), std::streamsize(bytes.size()));
  out.flush();
  if (!out) throw std::runtime_error(file.string() + ": cannot be written");
}

template <class T>
void append(std::string& bytes, T value) {
  bytes.append(reinterpret_cast<const char*>(&value), sizeof value);
}

std::string ply(const TriMesh& m, const char* what) {
  std::string s = std::string("ply\nformat binary_little_endian 1.0\ncomment unit mm; ") + what + "\nelement vertex " +
                  std::to_string(m.vertices.size()) +
                  "\nproperty float x\nproperty float y\nproperty float z\nelement face " +
                  std::to_string(m.triangles.size()) + "\nproperty list uchar int vertex_indices\nend_header\n";
  for (const Vec3& p : m.vertices)
    for (int i = 0; i < 3; ++i) append(s, float(p[i]));
  for (const auto& t : m.triangles) {
    append(s, std::uint8_t(3));
    for (const int v : t) append(s, std::int32_t(v));
  }
  return s;
}

double rounded(double x) { return std::round(x * 1e4) / 1e4 + 0.0; }
Json point(const Vec3& p) { return Json::array({rounded(p[0]), rounded(p[1]), rounded(p[2])}); }
Json unit(const Vec3& n) {
  const auto r = [](double x) { return std::round(x * 1e8) / 1e8 + 0.0; };
  return Json::array({r(n[0]), r(n[1]), r(n[2])});
}

/// One line a member, so that changes show well.
std::string lines(const Json& json) {
  std::string s = "{";
  bool first = true;
  for (const auto& [key, value] : json.items()) {
    s += (first ? "\n  " : ",\n  ") + Json(key).dump() + ": ";
    first = false;
    if (value.is_array() && !value.empty() && value[0].is_object()) {
      s += "[";
      for (std::size_t i = 0; i < value.size(); ++i) s += (i ? ",\n    " : "\n    ") + value[i].dump();
      s += "\n  ]";
    } else {
      s += value.dump();
    }
  }
  return s + "\n}\n";
}

}  // namespace

void write_vessel(const Vessel& v, const std::filesystem::path& folder) {
  std::filesystem::create_directories(folder);
  write_bytes(folder / "wall.ply", ply(v.wall.mesh, "wall of an artery with its caps"));
  write_bytes(folder / "picture.ply", ply(v.picture, "each triangle of the wall in four"));
  Json json;
  json["unit"] = "mm";
  json["regions"] = v.regions;
  json["vertex_region"] = v.region;
  json["caps"] = Json::array();
  for (std::size_t c = 0; c < v.wall.caps.size(); ++c) {
    Json triangles = Json::array();
    for (std::size_t t = 0; t < v.wall.patch.size(); ++t)
      if (v.wall.patch[t] == int(c)) triangles.push_back(t);
    json["caps"].push_back({{"name", v.wall.caps[c].name}, {"triangles", triangles}});
  }
  json["centrelines"] = Json::array();
  for (const NamedCurve& c : v.centrelines) {
    Json points = Json::array(), radius = Json::array();
    for (const Vec3& p : c.curve.points) points.push_back(point(p));
    for (const double r : c.curve.radius) radius.push_back(rounded(r));
    json["centrelines"].push_back({{"name", c.name},
                                   {"region", c.region},
                                   {"from", c.from},
                                   {"to", c.to},
                                   {"points", points},
                                   {"radius", radius}});
  }
  if (v.neck) {
    json["neck"] = {
        {"centre", point(v.neck->centre)}, {"normal", unit(v.neck->normal)}, {"diameter", rounded(v.neck->diameter)}};
    json["dome_height"] = rounded(v.dome_height);
  }
  if (v.bleb) json["bleb"] = {{"centre", point(v.bleb->first)}, {"radius", rounded(v.bleb->second)}};
  Json dimensions = {{"vertices", v.wall.mesh.vertices.size()}, {"triangles", v.wall.mesh.triangles.size()}};
  for (const auto& [name, value] : v.dimensions) dimensions[name] = rounded(value);
  json["dimensions"] = dimensions;
  write_bytes(folder / "vessel.json", lines(json));
}

}  // namespace insula::artery
