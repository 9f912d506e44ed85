// SPDX-License-Identifier: GPL-3.0-or-later
// Writes the viewer's scene bundle.
#include "engine/live/bundle.h"

#include <algorithm>
#include <bit>
#include <fstream>
#include <nlohmann/json.hpp>
#include <numbers>
#include <optional>

#include "core/base/input_error.h"
#include "core/base/spoken.h"
#include "core/mechanics/shell_body.h"
#include "core/registry/surgeon_requests.h"
#include "core/sim/settings.h"
#include "engine/authoring/inventory.h"
#include "engine/live/bundle_step_data.h"
#include "engine/live/bundle_writer.h"
#include "engine/live/contact_sides.h"
#include "engine/live/frame.h"
#include "engine/live/motion_guide.h"

namespace insula {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::ordered_json;

Json list(const Vec3& v) { return {v.x(), v.y(), v.z()}; }

/// The scene's view, or one that shows all its surfaces.
Json view_of(const Simulation& simulation) {
  if (const ViewSettings* v = simulation.view())
    return {{"eye", list(v->eye())},
            {"target", list(v->target())},
            {"up", list(v->up())},
            {"fov_deg", v->field_of_view() * 180 / std::numbers::pi}};
  Eigen::AlignedBox3d box;
  for (const Surface* s : simulation.surfaces())
    for (const Vec3& p : s->rest().vertices) box.extend(p);
  const Vec3 centre = box.isEmpty() ? Vec3::Zero().eval() : box.center();
  const double size = box.isEmpty() ? 0.1 : std::max(1e-3, box.diagonal().norm());
  return {{"eye", list(centre + size * Vec3(1.6, 1.2, 0.8))},
          {"target", list(centre)},
          {"up", list(Vec3::UnitZ())},
          {"fov_deg", 30}};
}

/// From and to of the good values, null: open.
Json band_of(const MeasureState& m) {
  Json out = Json::array();
  for (const auto& bound : m.band) out.push_back(bound ? Json(*bound) : Json());
  return out;
}

// Nobody needs to be nearer to a place that he only passes.
constexpr double pass_m = 0.003, pass_rad = 0.2618;

/// Targets of the motions that the exercise offers as a guide.
Json guide_of(const Exercise& exercise, const Simulation& simulation) {
  Json out = Json::array();
  for (const MotionEntry* motion : exercise.motions()) {
    if (!motion->guide()) continue;
    for (const GuidePose& g : guide_poses(load_motion(motion->file()), simulation)) {
      const Quat& q = g.sample.pose.q;
      out.push_back({{"hand", g.hand == 0 ? "left" : "right"},
                     {"tool", g.tool},
                     {"command", g.command},
                     {"argument", g.argument},
                     {"near_m", g.passes ? std::max(pass_m, motion->guide_distance()) : motion->guide_distance()},
                     {"near_rad", g.passes ? std::max(pass_rad, motion->guide_angle()) : motion->guide_angle()},
                     {"time_s", g.time_s},
                     {"p_m", list(g.sample.pose.p)},
                     {"q", {q.w(), q.x(), q.y(), q.z()}},
                     {"button1", g.sample.button1},
                     {"button2", g.sample.button2}});
    }
  }
  return out;
}

Json exercise_of(const Exercise& exercise, const Simulation& simulation) {
  Json goals = Json::array(), faults = Json::array();
  for (const GoalState& g : exercise.log().goals()) goals.push_back({{"id", g.id}, {"text", g.text}});
  for (const FaultState& f : exercise.log().faults()) faults.push_back({{"id", f.id}, {"text", f.text}});
  Json timers = Json::array(), measures = Json::array();
  for (const TimerState& t : exercise.log().timers())
    timers.push_back({{"id", t.id}, {"text", t.text}, {"limit_s", t.limit}});
  for (const MeasureState& m : exercise.log().measures())
    measures.push_back({{"id", m.id}, {"text", m.text}, {"unit", m.unit}, {"band", band_of(m)}});
  Json motions = Json::array();
  for (const MotionEntry* m : exercise.motions()) motions.push_back(m->id);
  return {{"id", exercise.id},    {"title", exercise.title()}, {"text", exercise.text()},
          {"goals", goals},       {"faults", faults},          {"timers", timers},
          {"measures", measures}, {"motions", motions},        {"guide", guide_of(exercise, simulation)}};
}

/// The region of each vertex: that of the nearest vertex of the wall at rest.
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

/// Where the vessel goes on beyond the model: the centre of each cap, its outward unit normal, and its radius.
Json ends_of(const ShellBody& shell) {
  Json out = Json::array();
  const std::vector<Vec3>& x = shell.model().wall.vertices;
  for (const WallModel::Cap& cap : shell.model().caps) {
    Vec3 moment = Vec3::Zero(), normal = Vec3::Zero();
    double area = 0;
    for (const int t : cap.triangles) {
      const auto& [a, b, c] = shell.model().wall.triangles[std::size_t(t)];
      const Vec3 n = 0.5 * (x[std::size_t(b)] - x[std::size_t(a)]).cross(x[std::size_t(c)] - x[std::size_t(a)]);
      moment += n.norm() / 3 * (x[std::size_t(a)] + x[std::size_t(b)] + x[std::size_t(c)]);
      normal += n;
      area += n.norm();
    }
    if (!(area > 0) || !(normal.norm() > 0)) continue;
    const Vec3 centre = moment / area, outward = normal.normalized();
    out.push_back(
        {{"centre_m", list(centre)}, {"outward", list(outward)}, {"radius_m", std::sqrt(area / std::numbers::pi)}});
  }
  return out;
}

/// Regions of a wall, its thickness in each, its ends, and the channels for its drawing.
void add_wall(Json& to, const ShellBody& shell, const ChannelTable& channels) {
  const std::vector<std::string>& regions = shell.model().regions;
  to["regions"] = regions;
  to["ends"] = ends_of(shell);
  to["region_thickness_m"] = Json::object();
  for (std::size_t r = 0; r < regions.size(); ++r)
    for (const ForceModel* f : shell.children_of<ForceModel>())
      if (const double thickness = f->wall_thickness(int(r)); thickness > 0)
        to["region_thickness_m"][regions[r]] = thickness;
  Json shades = Json::object(), pressures = Json::object();
  for (const ChannelEntry& e : channels.entries()) {
    if (e.channel->subject() != &shell) continue;
    if (e.channel->spec().role == Role::pulse) to["pulse_channel"] = e.id;
    if (shell.region(e.group()) < 0) continue;
    if (e.channel->spec().role == Role::shade) shades[e.group()] = e.id;
    // The first one in the order of the document.
    if (e.channel->quantity().name == Pressure::name && !pressures.contains(e.group())) pressures[e.group()] = e.id;
  }
  to["region_value"] = {{"channel_of_region", shades}, {"pressure_of_region", pressures}};
}

/// It has an edge that the scene lets cut.
bool cuts(const RigidBody& body) {
  const auto* sharp = dynamic_cast<const Param<Choice>*>(body.find_param("sharp"));
  return !body.tool().blade_edges.empty() && !(sharp && sharp->is("never"));
}

Json tool_json(const BundleWriter& writer, const RigidBody& body, std::size_t index) {
  const auto* instrument = dynamic_cast<const Instrument*>(&body);
  const auto* file = dynamic_cast<const Param<File>*>(body.find_param("model"));
  const ToolModel& model = body.tool();
  const std::string name = "t" + std::to_string(index);
  Json out = {{"index", index},
              {"id", body.id},
              {"kind", body.element},
              {"hand", instrument ? instrument->hand() : "none"},
              {"title", spoken(model.name)},
              {"cuts", cuts(body)}};
  if (file && !file->empty() && writer.picture((*file)(), name + "_picture.svg"))
    out["picture"] = name + "_picture.svg";
  out["properties"] = Json::array();
  for (const BodyProperty& p : body.properties())
    out["properties"].push_back({{"name", p.name}, {"value", p.value}, {"unit", p.unit}, {"text", p.text}});
  out["tags"] = body.tags();
  out["hinges"] = Json::array();
  for (const Hinge& h : model.hinges)
    out["hinges"].push_back({{"origin", list(h.origin)}, {"axis", list(h.axis)}, {"multiplier", h.multiplier}});
  out["parts"] = Json::array();
  for (std::size_t p = 0; p < model.parts.size(); ++p) {
    const ToolPart& part = model.parts[p];
    Json entry = {{"name", part.name}, {"link", part.link}, {"rgba", part.rgba}, {"material", part.material}};
    writer.mesh(entry, name + "_" + std::to_string(p), part.mesh.vertices, part.mesh.triangles);
    out["parts"].push_back(entry);
  }
  return out;
}

/// A hand with all its tools in order. Its home is that of the first tool.
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
    out.push_back({{"hand", first->hand()},
                   {"tool", tools.front()},
                   {"tools", tools},
                   {"home_p_m", list(home.p)},
                   {"home_q", {home.q.w(), home.q.x(), home.q.y(), home.q.z()}}});
  }
  return out;
}

/// What a command "set_NAME" has set at the start, in the command's unit: the value of the component's parameter NAME.
/// Its range and the command's are the same range in two units, and so give the factor. None if there is no such pair.
std::optional<double> start_value(const Component& component, const CommandInfo& command) {
  if (!command.name.starts_with("set_") || command.min == 0) return std::nullopt;
  const auto* param = dynamic_cast<const QuantityParam*>(component.find_param(command.name.substr(4)));
  if (!param || !param->min() || *param->min() == 0) return std::nullopt;
  return (*param)() * command.min / *param->min();
}

/// The usual argument of a command that the surgeon may ask for; none: the command is the instructor's alone.
std::optional<double> usual_request(const Component& component, const CommandInfo& command) {
  const auto* takes = dynamic_cast<const TakesSurgeonRequests*>(&component);
  if (!takes) return std::nullopt;
  for (const SurgeonRequest& r : takes->surgeon_requests())
    if (r.command == command.name) return r.usual;
  return std::nullopt;
}

/// The commands of all components, for pages and scripts.
Json commands_json(const Scene& scene) {
  Json out = Json::array();
  for (const Component* c : scene.components()) {
    Json commands = Json::array();
    for (const CommandInfo& info : c->commands()) {
      commands.push_back(
          {{"name", info.name}, {"doc", info.doc}, {"argument", info.argument}, {"min", info.min}, {"max", info.max}});
      if (const auto start = start_value(*c, info)) commands.back()["start"] = *start;
      if (const auto usual = usual_request(*c, info)) commands.back()["usual"] = *usual;
    }
    if (!commands.empty()) out.push_back({{"id", c->id}, {"element", c->element}, {"commands", commands}});
  }
  return out;
}

/// Writes the top of a bundle: title, text, view and force scale.
Json head_json(const Simulation& simulation, std::int64_t session) {
  const Exercise* exercise = simulation.exercise();
  Json json;
  json["version"] = 3;
  json["session"] = session;
  json["title"] = !simulation.scene().title().empty() ? simulation.scene().title()
                  : exercise                          ? exercise->title()
                                                      : simulation.scene().file().stem().string();
  json["description"] = exercise ? exercise->text() : "";
  json["view"] = view_of(simulation);
  if (const auto devices = simulation.scene().all<DeviceSettings>(); !devices.empty())
    json["force_scale"] = devices.front()->force_scale();
  return json;
}

/// Writes bodies with their surfaces to "bodies", and surfaces that never move to "static".
void add_bodies(Json& json, const BundleWriter& writer, const Simulation& simulation) {
  const auto bodies = picture_bodies(simulation);
  json["bodies"] = Json::array();
  for (std::size_t b = 0; b < bodies.size(); ++b) {
    Json entry = {{"index", b},
                  {"id", bodies[b]->id},
                  {"nodes", bodies[b]->nodes()},
                  {"rest", writer.points("body" + std::to_string(b) + "_rest.bin", bodies[b]->rest_nodes())},
                  {"surfaces", Json::array()}};
    if (const auto* shell = dynamic_cast<const ShellBody*>(bodies[b])) add_wall(entry, *shell, simulation.channels());
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
      continue;
    }
    writer.skin(entry, name, surface);
    if (const auto* shell = dynamic_cast<const ShellBody*>(*at)) {
      entry["regions"] = shell->model().regions;
      entry["vertex_region"] = writer.file(name + "_regions.bin", vertex_regions(surface, *shell));
    }
    json["bodies"][std::size_t(at - bodies.begin())]["surfaces"].push_back(entry);
  }
}

/// Writes a temporary file and renames it, so that a reader sees all of it or nothing.
void write_whole(const Json& json, const fs::path& whole) {
  const fs::path part = whole.string() + ".part";
  {
    std::ofstream out(part, std::ios::binary | std::ios::trunc);
    out << json.dump(1, ' ', false, Json::error_handler_t::replace) << '\n';
    out.close();
    if (!out) throw InputError(part.string() + ": cannot be written");
  }
  std::error_code error;
  fs::rename(part, whole, error);
  if (error) throw InputError(whole.string() + ": cannot be written: " + error.message());
}

}  // namespace

void write_bundle(const Simulation& simulation, const fs::path& dir, std::int64_t session, bool with_inventory) {
  std::error_code error;
  fs::create_directories(dir, error);
  if (error) throw InputError(dir.string() + ": cannot be created: " + error.message());
  const BundleWriter writer(dir);
  Json json = head_json(simulation, session);
  add_bodies(json, writer, simulation);
  json["tools"] = Json::array();
  const auto tools = picture_tools(simulation);
  for (std::size_t i = 0; i < tools.size(); ++i) json["tools"].push_back(tool_json(writer, *tools[i], i));
  json["hands"] = hands_json(simulation);
  json["contact_sides"] = contact_sides_json(simulation);
  json["commands"] = commands_json(simulation.scene());
  json["channels"] = channels_json(simulation.channels());
  json["drawables"] = drawables_json(writer, simulation);
  json["materials"] = materials_json(simulation.scene().materials());
  const Exercise* exercise = simulation.exercise();
  if (exercise && !with_inventory) json["exercise"] = exercise_of(*exercise, simulation);
  if (with_inventory) {
    write_inventory(inventory(simulation), dir / "inventory.json");
    json["inventory"] = "inventory.json";
  }
  write_whole(json, dir / "scene.json");
}

}  // namespace insula
