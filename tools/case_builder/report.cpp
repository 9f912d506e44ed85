// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/case_builder/report.h"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <tuple>

#include "core/base/input_error.h"
#include "core/mechanics/deformable_body.h"
#include "core/mechanics/rigid_body.h"
#include "core/mechanics/shell_body.h"
#include "core/registry/registry.h"
#include "core/sim/simulation.h"
#include "engine/live/headless.h"
#include "tools/case_builder/intake.h"
#include "tools/case_builder/picture.h"
#include "tools/case_builder/place.h"
#include "tools/case_builder/scenes.h"
#include "tools/case_builder/wall.h"

namespace insula::case_builder {
namespace {

std::string escaped(const std::string& s) {
  std::string out;
  for (const char c : s)
    out += c == '<' ? "&lt;" : c == '>' ? "&gt;" : c == '&' ? "&amp;" : c == '"' ? "&quot;" : std::string(1, c);
  return out;
}

std::array<int, 3> colour_of(const std::string& region) {
  if (region == "sac") return {224, 82, 74};
  if (region == "neck") return {244, 196, 66};
  if (region == "bleb") return {150, 60, 170};
  if (region == "ends") return {120, 120, 120};
  if (region == "parent") return {90, 140, 220};
  return region.back() % 2 ? std::array<int, 3>{90, 190, 150} : std::array<int, 3>{120, 170, 90};
}

Drawn drawn_regions(const artery::Vessel& v) {
  Drawn d{v.wall.mesh, {}, 1, false};
  for (const auto& t : v.wall.mesh.triangles) {
    // A triangle has the region most of its corners have.
    const int a = v.region[std::size_t(t[0])], b = v.region[std::size_t(t[1])], c = v.region[std::size_t(t[2])];
    d.colour.push_back(colour_of(v.regions[std::size_t(b == c ? b : a)]));
  }
  return d;
}

double extent(const TriMesh& m, Vec3& centre) {
  Vec3 low = Vec3::Constant(1e300), high = -low;
  for (const Vec3& p : m.vertices) low = low.cwiseMin(p), high = high.cwiseMax(p);
  centre = 0.5 * (low + high);
  return 0.55 * (high - low).norm();
}

std::string row(const std::string& what, const std::string& value, const char* judged, const std::string& advice = "") {
  return fmt::format("<tr class=\"{}\"><td>{}</td><td>{}</td><td>{}</td></tr>\n", judged, escaped(what), escaped(value),
                     escaped(advice));
}

std::string note_rows(const std::vector<Note>& notes) {
  std::string out;
  for (const Note& n : notes)
    out += row(n.kind == Note::Kind::repair    ? "repaired"
               : n.kind == Note::Kind::problem ? "problem"
                                               : "note",
               n.text,
               n.kind == Note::Kind::problem  ? "bad"
               : n.kind == Note::Kind::repair ? "mended"
                                              : "fact",
               n.advice);
  return out;
}

std::string pictures(const artery::Vessel& v, const CaseFolder& folder) {
  Vec3 centre;
  const double radius = extent(v.wall.mesh, centre);
  const artery::Neck& neck = *v.neck;
  const Drawn plane{disc(neck.centre, neck.normal, 0.8 * neck.diameter), {{250, 250, 250}}, 0.35, true};
  const Vec3 side = neck.normal.unitOrthogonal();
  std::string s = "<div class=\"row\">";
  s += "<figure>" + svg_picture({drawn_regions(v), plane}, side, neck.normal, centre, radius, 330) +
       "<figcaption>regions and the neck's plane, from the side</figcaption></figure>";
  s += "<figure>" + svg_picture({drawn_regions(v), plane}, neck.normal.cross(side), neck.normal, centre, radius, 330) +
       "<figcaption>turned by 90 degrees</figcaption></figure>";
  std::vector<Drawn> field{drawn_regions(v)};
  for (const auto& [name, colour] : {std::pair("frontal", std::array<int, 3>{214, 160, 150}),
                                     std::pair("temporal", std::array<int, 3>{200, 140, 140}),
                                     std::pair("insula", std::array<int, 3>{170, 120, 120})})
    field.push_back({read_ply(folder.lobes() / (std::string(name) + "_surface.ply")), {colour}, 0.5, false});
  s += "<figure>" + svg_picture(field, to_surgeon, Vec3(0, 0, 1), neck.centre, 18, 330) +
       "<figcaption>in the fissure, from the surgeon's side (lobes half transparent)</figcaption></figure></div>\n";
  return s;
}

/// Median and 95th percentile.
std::pair<double, double> median_and_most(std::vector<double> times) {
  if (times.empty()) return {0, 0};
  std::sort(times.begin(), times.end());
  return {times[times.size() / 2], times[std::size_t(0.95 * double(times.size() - 1))]};
}

bool clip_touches_vessel(const StepReport& r) {
  return std::any_of(r.contacts.begin(), r.contacts.end(), [](const ContactPoint& c) {
    const auto is_clip = [](const Body* b) {
      const auto* rigid = dynamic_cast<const RigidBody*>(b);
      return rigid && rigid->implant();
    };
    const bool vessel = dynamic_cast<const ShellBody*>(c.a) || dynamic_cast<const ShellBody*>(c.b);
    return vessel && (is_clip(c.a) || is_clip(c.b));
  });
}

}  // namespace

MeasuredMotion measure_motion(const fs::path& scene, double longest) {
  Registry registry;
  register_builtin(registry);
  const auto loaded = load_simulation(scene, registry);
  MeasuredMotion out;
  if (!loaded.simulation || !loaded.simulation->exercise() || loaded.simulation->exercise()->motions().empty())
    return out;
  Simulation& s = *loaded.simulation;
  const Motion motion = load_motion(s.exercise()->motions().front()->file());
  HeadlessRun run(s, motion);
  std::vector<double> times;
  double until = longest;
  while (s.time() < until) {
    const auto begin = std::chrono::steady_clock::now();
    run.step();
    const double ms =
        std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - begin).count() - run.haptic_ms();
    for (const Event& e : s.events())
      if (e.kind == "clip_released") until = std::min(until, s.time() + 0.5);
    if (!clip_touches_vessel(s.report())) continue;
    times.push_back(ms);
    out.rows = std::max(out.rows, s.report().rows);
  }
  out.steps = int(times.size());
  std::tie(out.step_ms, out.max_ms) = median_and_most(std::move(times));
  return out;
}

MeasuredScene measure_scene(const fs::path& scene, int steps) {
  MeasuredScene out;
  out.file = scene.filename().string();
  Registry registry;
  register_builtin(registry);
  const auto loaded = load_simulation(scene, registry);
  if (!loaded.simulation) {
    out.message = loaded.diagnostics.format();
    return out;
  }
  Simulation& s = *loaded.simulation;
  for (const Body* b : s.bodies())
    if (const auto* d = dynamic_cast<const DeformableBody*>(b)) out.nodes += d->nodes();
  out.budget_ms = 1000 * s.h();
  std::vector<double> times;
  for (int i = 0; i < steps; ++i) {
    const auto begin = std::chrono::steady_clock::now();
    s.step();
    times.push_back(std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - begin).count());
    out.finite = out.finite && s.report().finite;
    out.rows = std::max(out.rows, s.report().rows);
    if (i == 0) out.standing = standing_of(s);
  }
  std::tie(out.step_ms, out.max_ms) = median_and_most(std::move(times));
  return out;
}

namespace {

std::string head_of(const CaseFolder& folder) {
  return "<!doctype html><html lang=\"en\"><meta charset=\"utf-8\"><title>" + escaped(folder.name) +
         "</title><style>body{font:15px/1.45 sans-serif;max-width:1100px;margin:2em auto;padding:0 "
         "1em;color:#222}table{border-collapse:collapse;width:100%;margin:.6em 0 1.6em}"
         "td{border-bottom:1px solid #ddd;padding:.3em .6em;vertical-align:top}.bad td:first-child{border-left:5px "
         "solid #d33}.mended td:first-child{border-left:5px solid #e8a317}"
         ".good td:first-child{border-left:5px solid #2a2}.fact td:first-child{border-left:5px solid "
         "#99b}.row{display:flex;flex-wrap:wrap;gap:12px}figure{margin:0}figcaption{font-size:13px;color:#555}"
         "</style>\n" +
         fmt::format(
             "<h1>Case {}</h1><p><b>For training only, never for the care of patients.</b> Red: a problem, with what "
             "to do. Yellow: something that was mended. Green: as it should be.</p>\n",
             escaped(folder.name));
}

std::string section(const std::string& title, const std::string& rows) {
  return "<h2>" + title + "</h2><table>" + rows + "</table>\n";
}

std::string input_section(const Intake& in, const Options& options) {
  std::string s = row("file", fmt::format("{} ({})", in.facts.value("file", ""), in.facts.value("kind", "")), "fact");
  if (options.mirror)
    s += row("side",
             "left, mirrored at x = 0: what is left here is right in the patient, and positions in the case's files "
             "have the other sign of x than in yours",
             "fact", "Positions that you give are those of your files; --no-mirror takes them as they are.");
  s += row("size",
           fmt::format("{:.1f} mm across, {:.0f} mm2, {:.0f} mm3", in.facts.value("extent_mm", 0.0),
                       in.facts.value("area_mm2", 0.0), in.facts.value("volume_mm3", 0.0)),
           "good", "within what a stretch of cerebral artery measures");
  std::string openings;
  for (const Json& o : in.facts.at("openings"))
    openings += fmt::format("{}{:.2f} mm", openings.empty() ? "" : ", ", o.at("calibre_mm").get<double>());
  s += row("openings, from the widest", openings, "good");
  const bool crossed = in.facts.value("self_intersecting", false);
  s += row("given triangles",
           fmt::format("{} given, {} after mending, least angle {:.1f} degrees{}", in.facts.value("triangles_given", 0),
                       in.facts.value("triangles", 0), in.facts.value("least_angle_deg", 0.0),
                       crossed ? ", it runs through itself" : ", it does not run through itself"),
           crossed ? "bad" : "good",
           crossed ? "Make it anew from a grid: insula case intake FOLDER INPUT --rebuild \"0.2 mm\" --on" : "");
  return section("The input", s + note_rows(in.notes));
}

std::string mesh_rows(const artery::Vessel& v) {
  const artery::Quality q = artery::quality(v.wall.mesh);
  const int vertices = int(v.wall.mesh.vertices.size());
  std::string s = row(
      "vertices, triangles", fmt::format("{}, {}", vertices, v.wall.mesh.triangles.size()),
      vertices <= 2000 ? "good" : "bad",
      vertices <= 2000 ? "up to 2,000 are stepped in real time"
                       : "More than real time allows on most machines: insula case wall FOLDER --vertices 1650 --on");
  s += row("worst angle",
           fmt::format("{:.1f} degrees (mean of the least ones {:.1f})", q.min_angle_deg, q.mean_min_angle_deg),
           q.min_angle_deg >= 20 ? "good" : "bad",
           q.min_angle_deg >= 20 ? "" : "Give it other triangles: insula case wall FOLDER --vertices 2000 --on");
  s += row("holes, handles, pieces",
           fmt::format("{}, {} pieces, Euler number {}", q.closed ? "closed" : "OPEN", q.components, q.euler),
           q.closed && q.components == 1 && q.euler == 2 ? "good" : "bad");
  return s + row("self-intersections", q.self_intersecting ? "there are some" : "none",
                 q.self_intersecting ? "bad" : "good",
                 q.self_intersecting ? "insula case intake FOLDER INPUT --rebuild \"0.2 mm\" --on" : "");
}

std::string wall_section(const artery::Vessel& v, const Json& wall) {
  std::string s = mesh_rows(v);
  const double neck = v.neck->diameter;
  s += row(
      "neck", fmt::format("{:.2f} mm (circle of equal area), in the frame of the input see wall/vessel.json", neck),
      neck > 1.5 && neck < 9 ? "good" : "bad", "Not there? insula case wall FOLDER --neck \"X Y Z mm NX NY NZ\" --on");
  const auto width = v.dimensions.find("sac_width");
  s += row("dome",
           fmt::format("{:.2f} mm high, {:.2f} mm wide, dome to neck {:.2f}", v.dome_height,
                       width == v.dimensions.end() ? 0.0 : width->second, v.dome_height / neck),
           v.dome_height > 1 ? "good" : "bad",
           v.dome_height / neck < 1.2 ? "A broad neck: expect that one clip leaves a part of it." : "");
  for (const Json& w : wall.at("walls"))
    s +=
        row("wall of " + w.at("regions").get<std::string>(),
            fmt::format("{:g} mm thick, {:g} MPa", w.at("thickness_mm").get<double>(), w.at("young_MPa").get<double>()),
            "fact", "A proposal; change it in artery.xml.");
  return section("The wall", s + note_rows(notes_from_json(wall.at("notes"))));
}

std::string brain_section(const Json& brain) {
  std::string s;
  for (const Json& l : brain.at("lobes")) {
    const bool meshed = l.contains("nodes");
    const double least = l.value("least_angle_deg", 90.0);
    s += row(l.at("name"),
             fmt::format("{}{} triangles, {:.0f} mm3 about the fissure",
                         meshed ? fmt::format("{} nodes, {} tetrahedra, least angle {:.1f} degrees, ",
                                              l.value("nodes", 0), l.value("tetrahedra", 0), least)
                                : "",
                         l.value("triangles", 0), l.value("volume_mm3", 0.0)),
             least >= 5 ? "good" : "bad",
             least >= 5 ? "" : "Slivers: give a smoother surface or segmentation, or more nodes (--brain-nodes).");
  }
  return section("The brain", s + note_rows(notes_from_json(brain.at("notes"))));
}

std::string fissure_section(const Json& place) {
  std::string s;
  for (const Json& r : place.at("rooms")) {
    const double after = r.at("after_mm");
    s += row("room to the " + r.at("what").get<std::string>(),
             fmt::format("{:.2f} mm (before parting {:.2f} mm)", after, r.at("before_mm").get<double>()),
             after > 0 ? "good" : "bad",
             after > 0 ? "" : "insula case place FOLDER --spin \"45 deg\" --on, or keep less of the vessel");
  }
  return section("In the fissure", s + note_rows(notes_from_json(place.at("notes"))));
}

/// The table row with the measurements of an exercise that ran without motion of the hands.
std::string measured_rows(const MeasuredScene& m) {
  if (!m.message.empty())
    return row(m.file, m.message, "bad", "Mend the scene, or make the scenes again: insula case scenes FOLDER");
  const bool fast = m.step_ms <= m.budget_ms;
  std::string s = row(
      m.file,
      fmt::format("{} nodes, {} rows; hands still, a step takes {:.1f} ms (95 %: {:.1f} ms) of {:.1f} ms{}", m.nodes,
                  m.rows, m.step_ms, m.max_ms, m.budget_ms, m.finite ? "" : "; it LEFT THE RANGE OF NUMBERS"),
      fast && m.finite ? "good" : "bad",
      fast ? ""
           : "Slower than life here: fewer vertices (insula case wall FOLDER --vertices 1200 --on), or a faster "
             "machine.");
  for (const Note& n : judged(m.standing)) {
    const bool good = n.kind != Note::Kind::problem;
    s += row(m.file + ", as it begins", n.text, good ? "good" : "bad", n.advice);
  }
  return s;
}

std::string clipping_row(const fs::path& clipping, double budget) {
  const std::string what = clipping.filename().string() + ", scripted hands";
  const MeasuredMotion m = measure_motion(clipping, 12);
  if (m.steps == 0)
    return row(what, "the clip never touches the vessel", "bad",
               "Choose another clip or place: insula case scenes FOLDER --clip NAME --lift \"1 mm\" --slide \"1 mm\" "
               "--turn \"10 deg\"");
  return row(what,
             fmt::format("{} steps with the clip at the vessel, up to {} rows; a step takes {:.1f} ms (95 %: {:.1f} "
                         "ms) of {:.1f} ms",
                         m.steps, m.rows, m.step_ms, m.max_ms, budget),
             m.step_ms <= budget ? "good" : "bad",
             m.step_ms <= budget ? ""
                                 : "Slower than life while it is clipped: fewer vertices (insula case wall FOLDER "
                                   "--vertices 1200 --on), or a faster machine.");
}

std::string exercise_section(const CaseFolder& folder, const Json& scenes, Progress& progress) {
  const Json clip = scenes.at("clip");
  std::string s =
      row("clip for the neck",
          fmt::format("{}: blades of {:g} mm, {:.1f} mm wanted; the applier comes {:.0f} degrees off the line of sight",
                      clip.at("name").get<std::string>(), clip.at("blade_mm").get<double>(),
                      clip.at("needed_mm").get<double>(), clip.at("off_view_deg").get<double>()),
          "fact");
  double budget = 0;
  for (const fs::path& file : exercise_files(folder)) {
    progress.step("running " + file.filename().string());
    const MeasuredScene m = measure_scene(file, 60);
    s += measured_rows(m);
    if (m.message.empty()) budget = m.budget_ms;
  }
  progress.step("playing the clipping");
  s += clipping_row(exercise_files(folder)[2], budget);
  return section("The exercises, run on this machine", s + note_rows(notes_from_json(scenes.at("notes"))));
}

}  // namespace

void run_report(const CaseFolder& folder, const Options& options, Progress& progress) {
  progress.stage("report", 7);
  progress.step("reading the case");
  const Intake in = read_intake(folder);
  const artery::Vessel v = read_wall(folder.artery());
  if (!v.neck) throw InputError("the vessel has no neck; do the stage wall again");
  const Json wall = read_json(folder.wall() / "notes.json"), place = read_json(folder.path / "place.json"),
             scenes = read_json(folder.path / "scenes.json");
  std::string s = head_of(folder) + pictures(v, folder) + input_section(in, options) + wall_section(v, wall);
  if (fs::exists(folder.path / "brain.json")) s += brain_section(read_json(folder.path / "brain.json"));
  s += fissure_section(place);
  s += exercise_section(folder, scenes, progress);
  write_text(folder.path / "report.html", s + "</html>\n");
  progress.finish();
}

}  // namespace insula::case_builder
