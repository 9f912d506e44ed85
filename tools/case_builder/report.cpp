// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/case_builder/report.h"

#include <fmt/format.h>

#include <algorithm>

#include "core/base/input_error.h"
#include "engine/reports/svg_plot.h"
#include "tools/case_builder/findings.h"
#include "tools/case_builder/picture.h"
#include "tools/case_builder/place.h"
#include "tools/case_builder/scenes.h"
#include "tools/case_builder/wall.h"

namespace insula::case_builder {
namespace {

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

struct Picture {
  std::string file, caption, svg;
};

std::vector<Picture> pictures(const artery::Vessel& v, const CaseFolder& folder, const Approach& approach) {
  Vec3 centre;
  const double radius = extent(v.wall.mesh, centre);
  const artery::Neck& neck = *v.neck;
  const Drawn plane{disc(neck.centre, neck.normal, 0.8 * neck.diameter), {{250, 250, 250}}, 0.35, true};
  const Vec3 side = neck.normal.unitOrthogonal();
  const auto of_wall = [&](const Vec3& from) {
    return svg_picture({drawn_regions(v), plane}, from, neck.normal, centre, radius, 330);
  };
  std::vector<Drawn> field{drawn_regions(v)};
  constexpr std::array<int, 3> colours[] = {{214, 160, 150}, {200, 140, 140}, {170, 120, 120}};
  for (std::size_t k = 0; k < 3; ++k)
    field.push_back({read_ply(folder.lobes() / (approach.parts()[k] + "_surface.ply")), {colours[k]}, 0.5, false});
  return {{"report_side.svg", "regions and the neck's plane, from the side", of_wall(side)},
          {"report_front.svg", "turned by 90 degrees", of_wall(neck.normal.cross(side))},
          {"report_fissure.svg", "in the fissure, from the surgeon's side (lobes half transparent)",
           svg_picture(field, approach.to_surgeon, Vec3(0, 0, 1), neck.centre, 18, 330)}};
}

std::string row_of(const std::vector<Picture>& all) {
  std::string s = "<div class=\"row\">";
  for (const Picture& p : all) s += "<figure>" + p.svg + "<figcaption>" + p.caption + "</figcaption></figure>";
  return s + "</div>\n";
}

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

std::string table_of(const FindingSection& section) {
  std::string out = "<h2>" + section.title + "</h2><table>";
  for (const Finding& f : section.findings) {
    const char* judged = f.judged == Finding::Judged::bad      ? "bad"
                         : f.judged == Finding::Judged::mended ? "mended"
                         : f.judged == Finding::Judged::good   ? "good"
                                                               : "fact";
    out += fmt::format("<tr class=\"{}\"><td>{}</td><td>{}</td><td>{}</td></tr>\n", judged, escaped(f.what),
                       escaped(f.value), escaped(f.advice));
  }
  return out + "</table>\n";
}

/// The step times of the exercise that takes longest.
Json step_times(const std::vector<MeasuredScene>& exercises) {
  const auto slowest = std::max_element(exercises.begin(), exercises.end(),
                                        [](const auto& a, const auto& b) { return a.step_ms < b.step_ms; });
  return {
      {"p50", rounded(slowest->step_ms)}, {"p95", rounded(slowest->max_ms)}, {"budget", rounded(slowest->budget_ms)}};
}

Json for_programs(const artery::Vessel& v, const Json& wall, const Json& place, const Json& scenes,
                  const std::vector<MeasuredScene>& exercises, const std::vector<FindingSection>& sections) {
  Json out;
  out["neck"] = {{"diameter_mm", rounded(v.neck->diameter)},
                 {"confidence", wall.at("neck").at("confidence")},
                 {"proposals", wall.at("neck").at("proposals")}};
  for (const Json& r : place.at("rooms"))
    out["overlap_mm"][r.at("what").get<std::string>()] = rounded(std::max(0.0, -r.at("after_mm").get<double>()));
  out["step_ms"] = step_times(exercises);
  out["clipping"] = scenes.value("clipping", Json());
  out["problems"] = Json::array();
  for (const FindingSection& s : sections)
    for (const Finding& f : s.findings)
      if (f.judged == Finding::Judged::bad)
        out["problems"].push_back({{"id", f.id}, {"text", f.what + ": " + f.value}, {"what_to_do", f.advice}});
  return out;
}

}  // namespace

void run_report(const CaseFolder& folder, const fs::path& project, const Options& options, Progress& progress) {
  progress.stage("report", 7);
  progress.step("reading the case");
  const Intake in = read_intake(folder);
  const artery::Vessel v = read_wall(folder.artery());
  if (!v.neck) throw InputError("the vessel has no neck; do the stage wall again");
  const Json wall = read_json(folder.wall() / "notes.json"), place = read_json(folder.path / "place.json"),
             scenes = read_json(folder.path / "scenes.json");
  std::vector<MeasuredScene> exercises;
  for (const fs::path& file : exercise_files(folder)) {
    progress.step("running " + file.filename().string());
    exercises.push_back(measure_scene(file, 60));
    exercises.back().standing.arms_chosen = place.contains("retractors");
  }
  progress.step("playing the clipping");
  const MeasuredMotion clipping = measure_motion(exercise_file(folder, 3), 12);
  std::vector<FindingSection> sections{input_findings(in, options), wall_findings(v, wall)};
  if (fs::exists(folder.path / "brain.json")) sections.push_back(brain_findings(read_json(folder.path / "brain.json")));
  sections.push_back(fissure_findings(place));
  sections.push_back(exercise_findings(scenes, exercises, clipping));
  const std::vector<Picture> drawn = pictures(v, folder, read_approach(project, options.approach));
  for (const Picture& p : drawn) write_text(folder.path / p.file, p.svg);
  std::string html = head_of(folder) + row_of(drawn);
  for (const FindingSection& s : sections) html += table_of(s);
  write_text(folder.path / "report.html", html + "</html>\n");
  write_json(folder.path / "report.json", for_programs(v, wall, place, scenes, exercises, sections));
  progress.finish();
}

}  // namespace insula::case_builder
