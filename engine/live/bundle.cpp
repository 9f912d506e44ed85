// SPDX-License-Identifier: GPL-3.0-or-later
// Writes the viewer's scene bundle.
#include "engine/live/bundle.h"

#include <algorithm>
#include <bit>
#include <fstream>
#include <nlohmann/json.hpp>
#include <numbers>

#include "core/base/input_error.h"
#include "core/mechanics/shell_body.h"
#include "core/sim/settings.h"
#include "engine/live/frame.h"
#include "engine/authoring/inventory.h"

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

  /// A picture beside a tool's URDF; false when it has none.
  bool picture(const fs::path& urdf, const std::string& name) const {
    const fs::path from = urdf.parent_path() / "picture.svg";
    std::error_code error;
    if (!fs::is_regular_file(from, error)) return false;
    fs::copy_file(from, dir_ / name, fs::copy_options::overwrite_existing, error);
    if (error) throw InputError((dir_ / name).string() + ": cannot be written: " + error.message());
    return true;
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
  Json timers = Json::array(), measures = Json::array();
  for (const TimerState& t : exercise.log().timers()) timers.push_back({{"id", t.id}, {"text", t.text}, {"limit_s", t.limit}});
  for (const MeasureState& m : exercise.log().measures()) measures.push_back({{"id", m.id}, {"text", m.text}, {"unit", m.unit}});
  return {{"id", exercise.id}, {"title", exercise.title()}, {"text", exercise.text()}, {"goals", goals}, {"faults", faults}, {"timers", timers}, {"measures", measures}};
}

/// What the constraints know before the first step has reported anything: strands, the bleeding's field.
StepReport first_report(const Simulation& simulation) {
  StepReport report;
  for (const Constraint* c : simulation.constraints()) c->report(report);
  return report;
}

/// The region of each vertex: that of the wall's vertex it follows most closely at rest.
std::vector<std::uint32_t> vertex_regions(const Surface& surface, const ShellBody& shell) {
  std::vector<std::uint32_t> out;
  for (std::size_t i = 0; i < surface.points().size(); ++i) {
    const MaterialPoint& p = surface.points()[i];
    int best = p.node[0];
    double least = infinite;
    for (int k = 0; k < p.count; ++k) {
      const int node = p.node[std::size_t(k)];
      const double d = (shell.rest().vertices[std::size_t(node)] - surface.rest().vertices[i]).squaredNorm();
      if (d < least) {
        least = d;
        best = node;
      }
    }
    out.push_back(std::uint32_t(shell.model().vertex_region[std::size_t(best)]));
  }
  return out;
}

/// Centrelines, neck and bleb of a vessel.
void add_vessel(Json& to, const VesselModel& vessel) {
  to["regions"] = vessel.regions;
  to["centrelines"] = Json::array();
  for (const auto& c : vessel.centrelines) {
    Json points = Json::array();
    for (const Vec3& p : c.points) points.push_back(list(p));
    to["centrelines"].push_back({{"name", c.name}, {"region", c.region}, {"from", c.from}, {"to", c.to}, {"points", points}, {"radius", c.radius}});
  }
  if (vessel.neck_diameter > 0)
    to["neck"] = {{"centre", list(vessel.neck_centre)}, {"normal", list(vessel.neck_normal)}, {"diameter", vessel.neck_diameter}};
  if (vessel.bleb_radius > 0) to["bleb"] = {{"centre", list(vessel.bleb_centre)}, {"radius", vessel.bleb_radius}};
}

std::string title_of(const std::string& name) {
  std::string out = name;
  std::replace(out.begin(), out.end(), '_', ' ');
  return out;
}

Json clip_json(const ToolModel& model) {
  const ClipData& c = *model.clip;
  return {{"kind", c.kind},
          {"shape", c.shape},
          {"temporary", c.kind.find("temporary") != std::string::npos},
          {"blade_length_m", c.blade_length},
          {"closing_force_N", c.closing_force},
          {"opening_max_rad", model.opening_max}};
}

Json tool_json(const BundleWriter& writer, const RigidBody& body, std::size_t index) {
  const auto* instrument = dynamic_cast<const Instrument*>(&body);
  const auto* file = dynamic_cast<const Param<File>*>(body.find_param("model"));
  // A clip keeps its model to itself; what it was read from is there for everybody.
  const ToolModel model = instrument ? instrument->tool() : file && !file->empty() ? read_tool((*file)()) : ToolModel();
  const std::string name = "t" + std::to_string(index);
  Json out = {{"index", index}, {"id", body.id}, {"kind", body.element}, {"hand", instrument ? instrument->hand() : "none"}, {"title", title_of(model.name)}};
  if (file && !file->empty() && writer.picture((*file)(), name + "_picture.svg")) out["picture"] = name + "_picture.svg";
  if (model.clip) out["clip"] = clip_json(model);
  out["hinges"] = Json::array();
  for (const Hinge& h : model.hinges) out["hinges"].push_back({{"origin", list(h.origin)}, {"axis", list(h.axis)}, {"multiplier", h.multiplier}});
  out["parts"] = Json::array();
  for (std::size_t p = 0; p < model.parts.size(); ++p) {
    const ToolPart& part = model.parts[p];
    Json entry = {{"name", part.name}, {"link", part.link}, {"rgba", part.rgba}, {"material", part.material}};
    writer.mesh(entry, name + "_" + std::to_string(p), part.mesh.vertices, part.mesh.triangles);
    out["parts"].push_back(entry);
  }
  return out;
}

/// A hand with all its tools, in order; at home where its first one is.
Json hands_json(const Simulation& simulation) {
  Json out = Json::array();
  for (int h = 0; h < 2; ++h) {
    Json tools = Json::array();
    const Instrument* first = nullptr;
    for (std::size_t i = 0; i < simulation.instruments().size(); ++i) {
      const Instrument* tool = simulation.instruments()[i];
      if (tool->hand_index() != h) continue;
      if (!first) first = tool;
      tools.push_back(i);
    }
    if (!first) continue;
    const Pose home = first->home_pose();
    out.push_back({{"hand", first->hand()}, {"tool", tools.front()}, {"tools", tools}, {"home_p_m", list(home.p)},
                   {"home_q", {home.q.w(), home.q.x(), home.q.y(), home.q.z()}}});
  }
  return out;
}

/// What may be asked of whom, for pages and scripts.
Json commands_json(const Scene& scene) {
  Json out = Json::array();
  for (const Component* c : scene.components()) {
    Json commands = Json::array();
    for (const CommandInfo& info : c->commands())
      commands.push_back({{"name", info.name}, {"doc", info.doc}, {"argument", info.argument}, {"min", info.min}, {"max", info.max}});
    if (!commands.empty()) out.push_back({{"id", c->id}, {"element", c->element}, {"commands", commands}});
  }
  return out;
}

}  // namespace

void write_bundle(const Simulation& simulation, const fs::path& dir, std::int64_t session, bool with_inventory) {
  std::error_code error;
  fs::create_directories(dir, error);
  if (error) throw InputError(dir.string() + ": cannot be created: " + error.message());
  const BundleWriter writer(dir);
  Json json;
  json["version"] = 2;
  json["session"] = session;
  const Exercise* exercise = simulation.exercise();
  json["title"] = !simulation.scene().title().empty() ? simulation.scene().title() : exercise ? exercise->title() : simulation.scene().file().stem().string();
  json["description"] = exercise ? exercise->text() : "";
  json["view"] = view_of(simulation);
  if (const auto devices = simulation.scene().all<DeviceSettings>(); !devices.empty()) json["force_scale"] = devices.front()->force_scale();

  const auto bodies = picture_bodies(simulation);
  json["bodies"] = Json::array();
  for (std::size_t b = 0; b < bodies.size(); ++b) {
    Json entry = {{"index", b}, {"id", bodies[b]->id}, {"nodes", bodies[b]->nodes()},
                  {"rest", writer.points("body" + std::to_string(b) + "_rest.bin", bodies[b]->rest_nodes())},
                  {"surfaces", Json::array()}};
    if (const auto* shell = dynamic_cast<const ShellBody*>(bodies[b])) add_vessel(entry, shell->model());
    json["bodies"].push_back(entry);
  }
  json["static"] = Json::array();
  for (std::size_t s = 0; s < simulation.surfaces().size(); ++s) {
    const Surface& surface = *simulation.surfaces()[s];
    const std::string name = "s" + std::to_string(s);
    Json entry = {{"id", surface.id}, {"material", surface.material()}};
    writer.mesh(entry, name, surface.rest().vertices, surface.triangles());
    const auto at = std::find(bodies.begin(), bodies.end(), dynamic_cast<const DeformableBody*>(&surface.body()));
    if (at == bodies.end()) {
      json["static"].push_back(entry);
    } else {
      writer.skin(entry, name, surface);
      if (const auto* shell = dynamic_cast<const ShellBody*>(*at)) {
        entry["regions"] = shell->model().regions;
        entry["vertex_region"] = writer.file(name + "_regions.bin", vertex_regions(surface, *shell));
      }
      json["bodies"][std::size_t(at - bodies.begin())]["surfaces"].push_back(entry);
    }
  }

  json["tools"] = Json::array();
  const auto tools = picture_tools(simulation);
  for (std::size_t i = 0; i < tools.size(); ++i) json["tools"].push_back(tool_json(writer, *tools[i], i));
  json["hands"] = hands_json(simulation);
  json["commands"] = commands_json(simulation.scene());
  const StepReport start = first_report(simulation);
  json["strands"] = {{"count", start.strands.size()}, {"radius_m", strand_radius_m}};
  if (!start.bleeding.empty()) {
    const BleedingState& b = start.bleeding.front();
    json["bleeding"] = {{"origin", list(b.origin)}, {"up", list(b.up)}, {"radius_m", b.radius}};
  }
  if (exercise && !with_inventory) json["exercise"] = exercise_of(*exercise);
  if (with_inventory) {
    write_inventory(inventory(simulation), dir / "inventory.json");
    json["inventory"] = "inventory.json";
  }

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
