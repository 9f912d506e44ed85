// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/case_builder/case_folder.h"

#include <fmt/format.h>

#include <cmath>
#include <cstdint>
#include <fstream>

#include "core/base/input_error.h"
#include "core/model/formats/file_bytes.h"

namespace insula::case_builder {

Note problem(std::string id, std::string text, std::string advice) {
  return {Note::Kind::problem, std::move(text), std::move(advice), std::move(id)};
}

Json to_json(const std::vector<Note>& notes) {
  Json out = Json::array();
  for (const Note& n : notes) {
    Json one;
    one["kind"] = n.kind == Note::Kind::fact ? "fact" : n.kind == Note::Kind::repair ? "repair" : "problem";
    one["text"] = n.text;
    if (!n.advice.empty()) one["advice"] = n.advice;
    if (!n.id.empty()) one["id"] = n.id;
    out.push_back(one);
  }
  return out;
}

std::vector<Note> notes_from_json(const Json& json) {
  std::vector<Note> out;
  for (const Json& one : json) {
    const std::string kind = one.value("kind", "fact");
    out.push_back({kind == "fact"     ? Note::Kind::fact
                   : kind == "repair" ? Note::Kind::repair
                                      : Note::Kind::problem,
                   one.value("text", ""), one.value("advice", ""), one.value("id", "")});
  }
  return out;
}

Json read_json(const fs::path& file) {
  if (!fs::exists(file)) throw InputError(file.string() + ": does not exist; has the stage before been done?");
  Json json = Json::parse(read_file_bytes(file), nullptr, false);
  if (json.is_discarded())
    throw InputError(file.string() + ": is no JSON, or ends early; do the stage that writes it again");
  return json;
}

void write_text(const fs::path& file, const std::string& text) {
  std::error_code error;
  fs::create_directories(file.parent_path(), error);
  std::ofstream out(file, std::ios::binary);
  out.write(text.data(), std::streamsize(text.size()));
  out.flush();
  if (!out) throw InputError(file.string() + ": cannot be written");
}

void write_json(const fs::path& file, const Json& json) { write_text(file, json.dump(1) + "\n"); }

void write_ply(const fs::path& file, const TriMesh& m, const std::string& comment) {
  std::string s = "ply\nformat binary_little_endian 1.0\ncomment " + comment + "\nelement vertex " +
                  std::to_string(m.vertices.size()) +
                  "\nproperty float x\nproperty float y\nproperty float z\nelement face " +
                  std::to_string(m.triangles.size()) + "\nproperty list uchar int vertex_indices\nend_header\n";
  const auto append = [&s](auto value) { s.append(reinterpret_cast<const char*>(&value), sizeof value); };
  const std::size_t data = s.size();
  for (const Vec3& p : m.vertices)
    for (int i = 0; i < 3; ++i) append(float(p[i]));
  // assimp takes a first byte that is a line's end for a part of the header: the last bit of that coordinate is given
  // up.
  if (s.size() > data && (s[data] == '\n' || s[data] == '\r')) s[data] = char(s[data] ^ 1);
  for (const auto& t : m.triangles) {
    append(std::uint8_t(3));
    for (const int v : t) append(std::int32_t(v));
  }
  write_text(file, s);
}

TriMesh read_ply(const fs::path& file) {
  const std::string bytes = read_file_bytes(file);
  ByteCursor in(file, bytes);
  std::int64_t vertices = -1, triangles = -1;
  for (std::string_view line = in.line(); line != "end_header"; line = in.line()) {
    if (in.left() == 0) in.fail("is none of the case builder's files, or ends early");
    if (line.starts_with("element vertex ")) parse_integer(line.substr(15), vertices);
    if (line.starts_with("element face ")) parse_integer(line.substr(13), triangles);
  }
  TriMesh m;
  m.vertices.resize(in.checked_count(vertices, "the number of vertices", 12));
  for (Vec3& p : m.vertices)
    for (int a = 0; a < 3; ++a) p[a] = double(in.binary<float>(false, "a coordinate"));
  m.triangles.resize(in.checked_count(triangles, "the number of triangles", 13));
  for (auto& t : m.triangles) {
    if (in.binary<std::uint8_t>(false, "a face") != 3) in.fail("has a face that is no triangle");
    for (int& v : t) {
      v = in.binary<std::int32_t>(false, "a vertex of a face");
      if (v < 0 || v >= int(m.vertices.size())) in.fail("a triangle names a vertex that does not exist");
    }
  }
  return m;
}

Options read_options(CaseFolder& folder) {
  if (!fs::exists(folder.options_file()))
    throw InputError(folder.path.string() +
                     ": is no case: there is no case.json in it; make one with: insula case new NAME INPUT");
  const Json json = read_json(folder.options_file());
  if (!json.is_object() || !json.contains("name") || !json["name"].is_string() || !json.contains("options"))
    throw InputError(folder.options_file().string() + ": is no description of a case");
  folder.name = json["name"];
  return options_from_json(json["options"]);
}

void write_options(const CaseFolder& folder, const Options& options) {
  Json json;
  json["what"] = "A training case of Insula. For training only, never for the care of patients.";
  json["name"] = folder.name;
  json["options"] = to_json(options);
  write_json(folder.options_file(), json);
}

double rounded(double value) { return std::round(value * 1e5) / 1e5 + 0.0; }
std::string place(const Vec3& p) { return fmt::format("({:.1f}, {:.1f}, {:.1f})", p.x(), p.y(), p.z()); }

Json to_json(const Vec3& p) { return Json::array({rounded(p[0]), rounded(p[1]), rounded(p[2])}); }
Vec3 vec3_from(const Json& j) {
  if (!j.is_array() || j.size() != 3) throw InputError("a point has three numbers");
  return {j[0].get<double>(), j[1].get<double>(), j[2].get<double>()};
}

}  // namespace insula::case_builder
