// SPDX-License-Identifier: GPL-3.0-or-later
// Writes the viewer's scene bundle.
#include "engine/bundle.h"

#include <algorithm>
#include <bit>
#include <fstream>
#include <nlohmann/json.hpp>
#include <numbers>

#include "core/base/input_error.h"
#include "core/mechanics/soft_body.h"
#include "engine/frame.h"

namespace insula {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::ordered_json;

constexpr double strand_radius_m = 0.00015;

Json list(const Vec3& v) { return {v.x(), v.y(), v.z()}; }

class BundleWriter {
 public:
  explicit BundleWriter(const fs::path& dir) : dir_(dir) {}

  /// positions, indices and counts of a mesh; `name` begins its files' names.
  void mesh(Json& to, const std::string& name, const std::vector<Vec3>& vertices, const std::vector<std::array<int, 3>>& triangles) const {
    to["vertices"] = vertices.size();
    to["triangles"] = triangles.size();
    to["positions"] = points(name + "_positions.bin", vertices);
    std::vector<std::uint32_t> flat;
    flat.reserve(3 * triangles.size());
    for (const auto& t : triangles)
      for (int i : t) flat.push_back(std::uint32_t(i));
    to["indices"] = file(name + "_indices.bin", flat);
  }

  std::string points(const std::string& name, const std::vector<Vec3>& values) const {
    std::vector<float> flat;
    flat.reserve(3 * values.size());
    for (const Vec3& v : values)
      for (int k = 0; k < 3; ++k) flat.push_back(float(v[k]));
    return file(name, flat);
  }

  /// Four nodes and weights a vertex; vertices with fewer nodes repeat the first with weight 0.
  void skin(Json& to, const std::string& name, const Surface& surface) const {
    std::vector<std::uint32_t> nodes;
    std::vector<float> weights;
    for (const MaterialPoint& p : surface.points())
      for (int k = 0; k < 4; ++k) {
        nodes.push_back(std::uint32_t(p.node[std::size_t(k < p.count ? k : 0)]));
        weights.push_back(k < p.count ? float(p.weight[std::size_t(k)]) : 0.f);
      }
    to["skin_nodes"] = file(name + "_nodes.bin", nodes);
    to["skin_weights"] = file(name + "_weights.bin", weights);
  }

  template <class T>
  std::string file(const std::string& name, const std::vector<T>& values) const {
    static_assert(sizeof(T) == 4);
    std::ofstream out(dir_ / name, std::ios::binary | std::ios::trunc);
    for (const T& value : values) {
      auto bits = std::bit_cast<std::uint32_t>(value);
      if constexpr (std::endian::native == std::endian::big) bits = __builtin_bswap32(bits);
      out.write(reinterpret_cast<const char*>(&bits), 4);
    }
    out.close();
    if (!out) throw InputError((dir_ / name).string() + ": cannot be written");
    return name;
  }

 private:
  fs::path dir_;
};

/// The scene's view, or one that holds all its surfaces.
Json view_of(const Simulation& simulation) {
  if (const ViewSettings* v = simulation.view())
    return {{"eye", list(v->eye())}, {"target", list(v->target())}, {"up", list(v->up())}, {"fov_deg", v->field_of_view() * 180 / std::numbers::pi}};
  Eigen::AlignedBox3d box;
  for (const Surface* s : simulation.surfaces())
    for (const Vec3& p : s->rest().vertices) box.extend(p);
  const Vec3 centre = box.isEmpty() ? Vec3::Zero().eval() : box.center();
  const double size = box.isEmpty() ? 0.1 : std::max(1e-3, box.diagonal().norm());
  return {{"eye", list(centre + size * Vec3(1.6, 1.2, 0.8))}, {"target", list(centre)}, {"up", list(Vec3::UnitZ())}, {"fov_deg", 30}};
}

Json exercise_of(const Exercise& exercise) {
  Json goals = Json::array(), faults = Json::array();
  for (const GoalState& g : exercise.log().goals()) goals.push_back({{"id", g.id}, {"text", g.text}});
  for (const FaultState& f : exercise.log().faults()) faults.push_back({{"id", f.id}, {"text", f.text}});
  return {{"id", exercise.id}, {"title", exercise.title()}, {"text", exercise.text()}, {"goals", goals}, {"faults", faults}};
}

/// Strands are known to their constraints before the first step has reported any.
std::size_t strand_count(const Simulation& simulation) {
  StepReport report;
  for (const Constraint* c : simulation.constraints()) c->report(report);
  return report.strands.size();
}

}  // namespace

void write_bundle(const Simulation& simulation, const fs::path& dir, std::int64_t session) {
  std::error_code error;
  fs::create_directories(dir, error);
  if (error) throw InputError(dir.string() + ": cannot be created: " + error.message());
  const BundleWriter writer(dir);
  Json json;
  json["version"] = 1;
  json["session"] = session;
  const Exercise* exercise = simulation.exercise();
  json["title"] = !simulation.scene().title().empty() ? simulation.scene().title() : exercise ? exercise->title() : simulation.scene().file().stem().string();
  json["description"] = exercise ? exercise->text() : "";
  json["view"] = view_of(simulation);

  const auto bodies = picture_bodies(simulation);
  json["bodies"] = Json::array();
  for (std::size_t b = 0; b < bodies.size(); ++b)
    json["bodies"].push_back({{"index", b}, {"id", bodies[b]->id}, {"nodes", bodies[b]->nodes()},
                              {"rest", writer.points("body" + std::to_string(b) + "_rest.bin", bodies[b]->rest().nodes)},
                              {"surfaces", Json::array()}});
  json["static"] = Json::array();
  for (std::size_t s = 0; s < simulation.surfaces().size(); ++s) {
    const Surface& surface = *simulation.surfaces()[s];
    const std::string name = "s" + std::to_string(s);
    Json entry = {{"id", surface.id}, {"material", surface.material()}};
    writer.mesh(entry, name, surface.rest().vertices, surface.triangles());
    const auto at = std::find(bodies.begin(), bodies.end(), dynamic_cast<const SoftBody*>(&surface.body()));
    if (at == bodies.end()) {
      json["static"].push_back(entry);
    } else {
      writer.skin(entry, name, surface);
      json["bodies"][std::size_t(at - bodies.begin())]["surfaces"].push_back(entry);
    }
  }

  json["tools"] = Json::array();
  json["hands"] = Json::array();
  for (std::size_t i = 0; i < simulation.instruments().size(); ++i) {
    const Instrument& tool = *simulation.instruments()[i];
    const std::string hand = tool.hand();
    Json parts = Json::array();
    for (std::size_t p = 0; p < tool.tool().parts.size(); ++p) {
      const ToolPart& part = tool.tool().parts[p];
      Json entry = {{"name", part.name}, {"rgba", part.rgba}, {"material", part.material}};
      writer.mesh(entry, "t" + std::to_string(i) + "_" + std::to_string(p), part.mesh.vertices, part.mesh.triangles);
      parts.push_back(entry);
    }
    json["tools"].push_back({{"index", i}, {"id", tool.id}, {"hand", hand}, {"kind", tool.element}, {"parts", parts}});
    if (tool.hand_index() < 0) continue;  // a table-mounted arm is nobody's hand
    const Pose home = tool.home_pose();
    json["hands"].push_back({{"hand", hand}, {"tool", i}, {"home_p_m", list(home.p)}, {"home_q", {home.q.w(), home.q.x(), home.q.y(), home.q.z()}}});
  }
  json["strands"] = {{"count", strand_count(simulation)}, {"radius_m", strand_radius_m}};
  if (exercise) json["exercise"] = exercise_of(*exercise);

  const fs::path whole = dir / "scene.json", part = dir / "scene.json.part";
  {
    std::ofstream out(part, std::ios::binary | std::ios::trunc);
    out << json.dump(1, ' ', false, Json::error_handler_t::replace) << '\n';
    out.close();
    if (!out) throw InputError(part.string() + ": cannot be written");
  }
  fs::rename(part, whole, error);
  if (error) throw InputError(whole.string() + ": cannot be written: " + error.message());
}

}  // namespace insula
