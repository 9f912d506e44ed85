// SPDX-License-Identifier: GPL-3.0-or-later
// Reads vessel.json and wall.ply.
#include "core/model/wall_model.h"

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>
#include <set>

#include "core/base/text.h"
#include "core/model/formats/file_bytes.h"
#include "core/model/formats/ply_check.h"

namespace insula {
namespace {

using Json = nlohmann::json;
constexpr double metres_per_mm = 1e-3;
constexpr double largest_mm = 1e4;

/// wall.ply keeps its numbering of vertices, which vessel.json refers to; read_surface() would merge and renumber them.
class WallPly {
 public:
  WallPly(const std::filesystem::path& file, const std::string& bytes) : in_(file, bytes) {
    check_ply(file, bytes);  // everything the header announces is there
  }

  TriMesh read() {
    std::int64_t vertices = 0, faces = 0;
    bool ascii = false, swap = false, in_vertex = false;
    std::vector<std::string> scalars;  // type, name, type, name, ...
    std::vector<std::string> lists;
    for (;;) {
      const auto words = split_blanks(in_.line());
      if (words.empty() || words[0] == "comment" || words[0] == "obj_info" || words[0] == "ply") continue;
      if (words[0] == "end_header") break;
      if (words[0] == "format") {
        ascii = words[1] == "ascii";
        swap = !ascii && (words[1] == "binary_little_endian") != machine_is_little_endian;
      } else if (words[0] == "element") {
        in_vertex = words[1] == "vertex";
        if (in_vertex && faces == 0) parse_integer(words[2], vertices);
        else if (words[1] == "face" && vertices > 0) parse_integer(words[2], faces);
        else in_.fail("must hold vertices, then faces, and nothing else");
      } else if (words[0] == "property" && in_vertex && words.size() == 3) {
        scalars.insert(scalars.end(), {std::string(words[1]), std::string(words[2])});
      } else if (words[0] == "property" && !in_vertex && words.size() == 5) {
        lists = {std::string(words[2]), std::string(words[3])};
        if (++face_properties_ > 1) in_.fail("its faces must hold vertex indices and nothing else");
      } else {
        in_.fail("must hold plain numbers for vertices and one list of indices for faces");
      }
    }
    TriMesh mesh;
    for (std::int64_t v = 0; v < vertices; ++v) {
      Vec3 p = Vec3::Zero();
      for (std::size_t k = 0; k < scalars.size(); k += 2) {
        const double x = value(scalars[k], ascii, swap);
        const std::string& name = scalars[k + 1];
        if (name.size() == 1 && name[0] >= 'x' && name[0] <= 'z') p[name[0] - 'x'] = x * metres_per_mm;
      }
      if (!p.allFinite() || p.cwiseAbs().maxCoeff() > largest_mm * metres_per_mm)
        in_.fail("vertex " + std::to_string(v) + " is not finite or too far away");
      mesh.vertices.push_back(p);
    }
    for (std::int64_t f = 0; f < faces; ++f) {
      if (lists.empty() || value(lists[0], ascii, swap) != 3) in_.fail("face " + std::to_string(f) + " is no triangle");
      std::array<int, 3> t;
      for (int& v : t) {
        const double x = value(lists[1], ascii, swap);
        if (!(x >= 0 && x < double(vertices) && x == std::floor(x)))
          in_.fail("face " + std::to_string(f) + " names a vertex that does not exist");
        v = int(x);
      }
      mesh.triangles.push_back(t);
    }
    return mesh;
  }

 private:
  double value(const std::string& type, bool ascii, bool swap) {
    constexpr const char* what = "a value that its header announces";
    if (ascii) return in_.number(what);
    if (type == "float" || type == "float32") return double(in_.binary<float>(swap, what));
    if (type == "double" || type == "float64") return in_.binary<double>(swap, what);
    if (type == "uchar" || type == "uint8") return in_.binary<std::uint8_t>(swap, what);
    if (type == "int" || type == "int32") return in_.binary<std::int32_t>(swap, what);
    if (type == "uint" || type == "uint32") return in_.binary<std::uint32_t>(swap, what);
    in_.fail("the number type " + in_quotes(type) + " is not used for walls");
  }
  ByteCursor in_;
  int face_properties_ = 0;
};

void check_wall(const std::filesystem::path& file, const TriMesh& wall) {
  std::vector<std::pair<int, int>> edges;
  std::vector<char> used(wall.vertices.size());
  double volume = 0;
  for (std::size_t t = 0; t < wall.triangles.size(); ++t) {
    const auto [a, b, c] = wall.triangles[t];
    const Vec3 &p = wall.vertices[std::size_t(a)], &q = wall.vertices[std::size_t(b)],
               &r = wall.vertices[std::size_t(c)];
    if (!((q - p).cross(r - p).norm() > 1e-14)) fail(file, "triangle " + std::to_string(t) + " is flat");
    volume += (p - wall.vertices[0]).dot((q - wall.vertices[0]).cross(r - wall.vertices[0])) / 6;
    for (const auto& e : {std::pair(a, b), std::pair(b, c), std::pair(c, a)})
      edges.push_back(e), used[std::size_t(e.first)] = 1;
  }
  const auto unused = std::find(used.begin(), used.end(), 0);
  if (unused != used.end()) fail(file, "no triangle uses vertex " + std::to_string(unused - used.begin()));
  std::sort(edges.begin(), edges.end());
  const auto name = [](const std::pair<int, int>& e) {
    return "the edge between vertices " + std::to_string(e.first) + " and " + std::to_string(e.second);
  };
  const auto twice = std::adjacent_find(edges.begin(), edges.end());
  if (twice != edges.end()) fail(file, name(*twice) + " belongs to two triangles in the same direction");
  for (const auto& e : edges)
    if (!std::binary_search(edges.begin(), edges.end(), std::pair(e.second, e.first)))
      fail(file, "is not closed: " + name(e) + " is open");
  if (!(volume > 0)) fail(file, "is turned inside out: its triangles must be counter-clockwise as seen from outside");
}

class VesselReader {
 public:
  explicit VesselReader(const std::filesystem::path& file) : file_(file) {}

  WallModel read() {
    Json json;
    try {
      json = Json::parse(read_file_bytes(file_, 1u << 26));
    } catch (const Json::exception& e) {
      bad("is no valid JSON: " + shown(e.what()));
    }
    if (!json.is_object()) bad("must hold one object");
    if (!json.contains("unit") || json["unit"] != "mm") bad("unit must be \"mm\"");
    const auto wall_file = file_.parent_path() / "wall.ply";
    const std::string bytes = read_file_bytes(wall_file);
    out_.wall = WallPly(wall_file, bytes).read();
    check_wall(wall_file, out_.wall);
    read_regions(list(json, "regions", ""), list(json, "vertex_region", ""));
    read_caps(list(json, "caps", ""));
    read_centrelines(list(json, "centrelines", ""));
    if (json.contains("neck")) read_neck(json, json["neck"]);
    if (json.contains("bleb")) {
      out_.bleb_centre = point(member(json["bleb"], "centre", "bleb."), "bleb.centre");
      out_.bleb_radius = positive(member(json["bleb"], "radius", "bleb."), "bleb.radius");
    }
    return std::move(out_);
  }

 private:
  [[noreturn]] void bad(const std::string& text) const { fail(file_, text); }
  const Json& member(const Json& json, const char* key, const std::string& where) const {
    if (!json.is_object() || !json.contains(key)) bad(where + key + " is missing");
    return json[key];
  }
  const Json& list(const Json& json, const char* key, const std::string& where) const {
    const Json& value = member(json, key, where);
    if (!value.is_array()) bad(where + key + " must be a list");
    return value;
  }
  std::string text(const Json& json, const std::string& what) const {
    if (!json.is_string() || json.get<std::string>().empty()) bad(what + " must be text");
    return json.get<std::string>();
  }
  double length(const Json& json, const std::string& what) const {
    if (!json.is_number() || !(std::abs(json.get<double>()) <= largest_mm)) bad(what + " must be a number (mm)");
    return json.get<double>() * metres_per_mm;
  }
  double positive(const Json& json, const std::string& what) const {
    const double v = length(json, what);
    if (!(v > 0)) bad(what + " must be positive");
    return v;
  }
  Vec3 point(const Json& json, const std::string& what) const {
    if (!json.is_array() || json.size() != 3) bad(what + " must be three numbers (mm)");
    return {length(json[0], what), length(json[1], what), length(json[2], what)};
  }
  int index(const Json& json, std::size_t limit, const std::string& what) const {
    if (!json.is_number_integer() || json.get<double>() < 0 || json.get<double>() >= double(limit))
      bad(what + " holds " + shown(json.dump()) + ", which is not between 0 and " +
          std::to_string(std::int64_t(limit) - 1));
    return json.get<int>();
  }
  void new_name(std::set<std::string>& names, const std::string& name, const char* kind) const {
    if (!names.insert(name).second) bad(std::string("two ") + kind + " are called " + in_quotes(name));
  }

  void read_regions(const Json& names, const Json& of_vertex) {
    std::set<std::string> seen;
    for (const Json& n : names) {
      out_.regions.push_back(text(n, "a region's name"));
      new_name(seen, out_.regions.back(), "regions");
    }
    if (out_.regions.empty()) bad("regions must name at least one region");
    if (of_vertex.size() != out_.wall.vertices.size())
      bad("vertex_region has " + std::to_string(of_vertex.size()) + " entries, and wall.ply " +
          std::to_string(out_.wall.vertices.size()) + " vertices");
    for (const Json& r : of_vertex) out_.vertex_region.push_back(index(r, out_.regions.size(), "vertex_region"));
  }

  void read_caps(const Json& caps) {
    std::set<std::string> seen;
    std::set<int> taken;
    for (const Json& json : caps) {
      WallModel::Cap cap;
      cap.name = text(member(json, "name", "a cap's "), "a cap's name");
      new_name(seen, cap.name, "caps");
      const std::string what = "cap " + in_quotes(cap.name);
      for (const Json& t : list(json, "triangles", what + ": ")) {
        cap.triangles.push_back(index(t, out_.wall.triangles.size(), what));
        if (!taken.insert(cap.triangles.back()).second)
          bad(what + ": triangle " + std::to_string(cap.triangles.back()) + " is in a cap already");
      }
      if (cap.triangles.empty()) bad(what + " has no triangles");
      std::sort(cap.triangles.begin(), cap.triangles.end());
      out_.caps.push_back(std::move(cap));
    }
    if (out_.caps.empty()) bad("caps must hold at least one cap");
  }

  void read_centrelines(const Json& lines) {
    std::set<std::string> seen;
    for (const Json& json : lines) {
      WallModel::Centreline line;
      line.name = text(member(json, "name", "a centreline's "), "a centreline's name");
      new_name(seen, line.name, "centrelines");
      const std::string what = "centreline " + in_quotes(line.name) + ": ";
      line.region = text(member(json, "region", what), what + "region");
      if (out_.region(line.region) < 0) bad(what + "there is no region " + in_quotes(line.region));
      line.from = text(member(json, "from", what), what + "from");
      line.to = text(member(json, "to", what), what + "to");
      for (const Json& p : list(json, "points", what)) {
        line.points.push_back(point(p, what + "points"));
        if (line.points.size() > 1 && !((line.points.back() - line.points[line.points.size() - 2]).norm() > 1e-9))
          bad(what + "two points in a row are the same");
      }
      if (line.points.size() < 2) bad(what + "points must be two or more");
      for (const Json& r : list(json, "radius", what)) line.radius.push_back(positive(r, what + "radius"));
      if (line.radius.size() != line.points.size())
        bad(what + "has " + std::to_string(line.points.size()) + " points and " + std::to_string(line.radius.size()) +
            " radii");
      out_.centrelines.push_back(std::move(line));
    }
    if (out_.centrelines.empty()) bad("centrelines must hold at least one centreline");
  }

  void read_neck(const Json& json, const Json& neck) {
    out_.has_neck = true;
    out_.neck_centre = point(member(neck, "centre", "neck."), "neck.centre");
    const Vec3 normal = point(member(neck, "normal", "neck."), "neck.normal") / metres_per_mm;
    if (!(std::abs(normal.norm() - 1) < 1e-3)) bad("neck.normal must have length 1");
    out_.neck_normal = normal.normalized();
    out_.neck_diameter = positive(member(neck, "diameter", "neck."), "neck.diameter");
    out_.dome_height = positive(member(json, "dome_height", ""), "dome_height");
  }

  std::filesystem::path file_;
  WallModel out_;
};

}  // namespace

int WallModel::region(const std::string& name) const {
  const auto at = std::find(regions.begin(), regions.end(), name);
  return at == regions.end() ? -1 : int(at - regions.begin());
}

WallModel read_wall(const std::filesystem::path& json_file) { return VesselReader(json_file).read(); }

}  // namespace insula
