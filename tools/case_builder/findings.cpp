// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/case_builder/findings.h"

#include <fmt/format.h>

#include "core/base/text.h"
#include "tools/artery/branches_of_sac.h"
#include "tools/artery/surface.h"
#include "tools/case_builder/region_walls.h"
#include "tools/case_builder/wall_patches.h"

namespace insula::case_builder {
namespace {

using Judged = Finding::Judged;

Finding fact(std::string what, std::string value, std::string remark = "") {
  return {std::move(what), std::move(value), Judged::fact, std::move(remark)};
}

/// `id` and `advice` are for the case that it is not good.
Finding check(bool good, std::string id, std::string what, std::string value, std::string advice) {
  if (good) return {std::move(what), std::move(value), Judged::good};
  return {std::move(what), std::move(value), Judged::bad, std::move(advice), std::move(id)};
}

Finding finding_of(const Note& n, const std::string& what = "") {
  if (n.kind == Note::Kind::problem) return {what.empty() ? "problem" : what, n.text, Judged::bad, n.advice, n.id};
  if (n.kind == Note::Kind::repair) return {what.empty() ? "repaired" : what, n.text, Judged::mended, n.advice};
  return {what.empty() ? "note" : what, n.text, what.empty() ? Judged::fact : Judged::good, n.advice};
}

void add_notes(FindingSection& s, const std::vector<Note>& notes) {
  for (const Note& n : notes) s.findings.push_back(finding_of(n));
}

constexpr const char* rebuild = "insula case intake FOLDER INPUT --rebuild \"0.2 mm\" --on";
constexpr int most_vertices = 2000;   // in real time
constexpr double least_angle = 20;    // degrees, of the wall's triangles
constexpr double least_of_lobes = 5;  // degrees, of the lobes' tetrahedra
constexpr double sure_neck = 0.85;    // of neck_confidence()
constexpr double broad_neck = 1.2;    // dome height over neck diameter

void add_mesh(FindingSection& s, const artery::Vessel& v) {
  const artery::Quality q = artery::quality(v.wall.mesh);
  const int vertices = int(v.wall.mesh.vertices.size());
  s.findings.push_back(
      check(vertices <= most_vertices, "wall_too_fine", "vertices, triangles",
            fmt::format("{}, {}", vertices, v.wall.mesh.triangles.size()),
            "More than real time allows on most machines: insula case wall FOLDER --vertices 1650 --on"));
  s.findings.push_back(
      check(q.min_angle_deg >= least_angle, "wall_thin_triangles", "worst angle",
            fmt::format("{:.1f} degrees (mean of the least ones {:.1f})", q.min_angle_deg, q.mean_min_angle_deg),
            "Give it other triangles: insula case wall FOLDER --vertices 2000 --on"));
  s.findings.push_back(check(
      q.closed && q.components == 1 && q.euler == 2, "wall_open", "holes, handles, pieces",
      fmt::format("{}, {} pieces, Euler number {}", q.closed ? "closed" : "OPEN", q.components, q.euler), rebuild));
  s.findings.push_back(check(!q.self_intersecting, "wall_self_intersecting", "self-intersections",
                             q.self_intersecting ? "there are some" : "none", rebuild));
}

/// How sure the neck is, and where else it may be, as options to be given.
void add_neck_proposals(FindingSection& s, const Json& neck) {
  const double confidence = neck.at("confidence");
  const Json& proposals = neck.at("proposals");
  if (proposals.empty()) return;
  std::string others;
  for (std::size_t k = 1; k < proposals.size(); ++k) {  // the first is the neck
    const Json& p = proposals[k];
    if (!p.at("planar").get<bool>()) continue;
    others +=
        fmt::format("{}{}, {:.2f} mm: --neck \"{}\"", others.empty() ? "" : "; ", p.at("method").get<std::string>(),
                    p.at("diameter_mm").get<double>(), p.at("option").get<std::string>());
  }
  s.findings.push_back(check(confidence >= sure_neck, "neck_unsure", "agreement of three methods on the neck",
                             fmt::format("{:.0f} %", 100 * confidence),
                             "Look whether the disc in the pictures stands in the neck. If not, move it (--neck, "
                             "--neck-points)."));
  if (!others.empty()) s.findings.push_back(fact("other proposals", others, "insula case wall FOLDER --neck ... --on"));
}

}  // namespace

FindingSection input_findings(const Intake& in, const Options& options) {
  FindingSection s{"The input", {}};
  s.findings.push_back(fact("file", fmt::format("{} ({})", in.facts.value("file", ""), in.facts.value("kind", ""))));
  if (options.mirror)
    s.findings.push_back(fact("side",
                              "left, mirrored at x = 0: what is left here is right in the patient, and positions in "
                              "the case's files have the other sign of x than in yours",
                              "Positions that you give are those of your files; --no-mirror takes them as they are."));
  s.findings.push_back({"size",
                        fmt::format("{:.1f} mm across, {:.0f} mm2, {:.0f} mm3", in.facts.value("extent_mm", 0.0),
                                    in.facts.value("area_mm2", 0.0), in.facts.value("volume_mm3", 0.0)),
                        Judged::good, "within what a stretch of cerebral artery measures"});
  std::string openings;
  for (const Json& o : in.facts.at("openings"))
    openings += fmt::format("{}{:.2f} mm", openings.empty() ? "" : ", ", o.at("calibre_mm").get<double>());
  s.findings.push_back({"openings, from the widest", openings, Judged::good});
  const bool crossed = in.facts.value("self_intersecting", false);
  s.findings.push_back(check(
      !crossed, "input_self_intersecting", "given triangles",
      fmt::format("{} given, {} after mending, least angle {:.1f} degrees{}", in.facts.value("triangles_given", 0),
                  in.facts.value("triangles", 0), in.facts.value("least_angle_deg", 0.0),
                  crossed ? ", it runs through itself" : ", it does not run through itself"),
      std::string("Make it anew from a grid: ") + rebuild));
  add_notes(s, in.notes);
  return s;
}

FindingSection wall_findings(const artery::Vessel& v, const Json& wall) {
  FindingSection s{"The wall", {}};
  add_mesh(s, v);
  const double neck = v.neck->diameter;
  s.findings.push_back(
      check(neck > 1.5 && neck < 9, "neck_size", "neck",
            fmt::format("{:.2f} mm (circle of equal area), in the frame of the input see wall/vessel.json", neck),
            "Not there? insula case wall FOLDER --neck \"X Y Z mm NX NY NZ\" --on"));
  add_neck_proposals(s, wall.at("neck"));
  const std::vector<std::string> of_sac = artery::branches_of_sac(v);
  s.findings.push_back(check(of_sac.empty(), "branch_from_sac", "branches that leave the sac",
                             of_sac.empty() ? "none" : joined(of_sac),
                             "A clip at the neck shuts them. Move the neck so that they stay on the vessel's side, and "
                             "expect that a part of the dome is left."));
  const auto width = v.dimensions.find("sac_width");
  Finding dome = check(v.dome_height > 1, "dome_low", "dome",
                       fmt::format("{:.2f} mm high, {:.2f} mm wide, dome to neck {:.2f}", v.dome_height,
                                   width == v.dimensions.end() ? 0.0 : width->second, v.dome_height / neck),
                       "Hardly a sac: look whether the neck is in its place.");
  if (v.dome_height / neck < broad_neck) dome.advice += " A broad neck: expect that one clip leaves a part of it.";
  s.findings.push_back(dome);
  for (const WallOf& w : walls_from(wall.at("walls")))
    s.findings.push_back(fact("wall of " + w.regions,
                              fmt::format("{:g} mm thick, {:g} MPa", w.thickness_mm, w.young_mpa),
                              "Change it: insula case wall FOLDER --wall \"neck.young=7 MPa\" --on"));
  const std::vector<PatchOf> patches = patches_from(wall.value("patches", Json::array()));
  for (std::size_t k = 0; k < patches.size(); ++k)
    s.findings.push_back(fact(fmt::format("painted part {} of the wall", k + 1),
                              fmt::format("{:g} mm thick, {:g} MPa, within {:g} mm of {} point{}",
                                          patches[k].thickness_mm, patches[k].young_mpa, patches[k].radius_mm,
                                          patches[k].spots.size(), patches[k].spots.size() == 1 ? "" : "s")));
  add_notes(s, notes_from_json(wall.at("notes")));
  return s;
}

FindingSection brain_findings(const Json& brain) {
  FindingSection s{"The brain", {}};
  for (const Json& l : brain.at("lobes")) {
    const double least = l.value("least_angle_deg", 90.0);
    const std::string tetrahedra = l.contains("nodes")
                                       ? fmt::format("{} nodes, {} tetrahedra, least angle {:.1f} degrees, ",
                                                     l.value("nodes", 0), l.value("tetrahedra", 0), least)
                                       : "";
    s.findings.push_back(check(least >= least_of_lobes, "lobe_slivers", l.at("name"),
                               fmt::format("{}{} triangles, {:.0f} mm3 about the fissure", tetrahedra,
                                           l.value("triangles", 0), l.value("volume_mm3", 0.0)),
                               "Slivers: give a smoother surface or segmentation, or more nodes (--brain-nodes)."));
  }
  add_notes(s, notes_from_json(brain.at("notes")));
  return s;
}

FindingSection fissure_findings(const Json& place) {
  FindingSection s{"In the fissure", {}};
  for (const Json& r : place.at("rooms")) {
    const double after = r.at("after_mm");
    s.findings.push_back(
        check(after > 0, "overlap", "room to the " + r.at("what").get<std::string>(),
              fmt::format("{:.2f} mm (before parting {:.2f} mm)", after, r.at("before_mm").get<double>()),
              "insula case place FOLDER --spin \"45 deg\" --on, or keep less of the vessel"));
  }
  add_notes(s, notes_from_json(place.at("notes")));
  return s;
}

namespace {

void add_measured(FindingSection& s, const MeasuredScene& m) {
  if (!m.message.empty()) {
    s.findings.push_back({m.file, m.message, Judged::bad,
                          "Mend the scene, or make the scenes again: insula case scenes FOLDER", "scene_refused"});
    return;
  }
  const bool fast = m.step_ms <= m.budget_ms;
  s.findings.push_back(check(
      fast && m.finite, m.finite ? "too_slow" : "not_finite", m.file,
      fmt::format("{} nodes, {} rows; hands still, a step takes {:.1f} ms (95 %: {:.1f} ms) of {:.1f} ms{}", m.nodes,
                  m.rows, m.step_ms, m.max_ms, m.budget_ms, m.finite ? "" : "; it LEFT THE RANGE OF NUMBERS"),
      "Slower than life here: fewer vertices (insula case wall FOLDER --vertices 1200 --on), or a faster machine."));
  for (const Note& n : judged(m.standing)) s.findings.push_back(finding_of(n, m.file + ", as it begins"));
}

Finding clipping_finding(const MeasuredScene& scene, const MeasuredMotion& m) {
  const std::string what = scene.file + ", scripted hands";
  if (m.steps == 0)
    return {what, "the clip never touches the vessel", Judged::bad,
            "Choose another clip or place: insula case scenes FOLDER --clip NAME --lift \"1 mm\" --slide \"1 mm\" "
            "--turn \"10 deg\"",
            "clip_touches_nothing"};
  return check(m.step_ms <= scene.budget_ms, "too_slow_while_clipped", what,
               fmt::format("{} steps with the clip at the vessel, up to {} rows; a step takes {:.1f} ms (95 %: {:.1f} "
                           "ms) of {:.1f} ms",
                           m.steps, m.rows, m.step_ms, m.max_ms, scene.budget_ms),
               "Slower than life while it is clipped: fewer vertices (insula case wall FOLDER --vertices 1200 --on), "
               "or a faster machine.");
}

}  // namespace

FindingSection exercise_findings(const Json& scenes, const std::vector<MeasuredScene>& exercises,
                                 const MeasuredMotion& clipping) {
  FindingSection s{"The exercises, run on this machine", {}};
  const Json& clip = scenes.at("clip");
  s.findings.push_back(fact(
      "clip for the neck",
      fmt::format("{}: blades of {:g} mm, {:.1f} mm wanted; the applier comes {:.0f} degrees off the line of sight",
                  clip.at("name").get<std::string>(), clip.at("blade_mm").get<double>(),
                  clip.at("needed_mm").get<double>(), clip.at("off_view_deg").get<double>())));
  for (const MeasuredScene& m : exercises) add_measured(s, m);
  s.findings.push_back(clipping_finding(exercises.at(2), clipping));
  add_notes(s, notes_from_json(scenes.at("notes")));
  return s;
}

}  // namespace insula::case_builder
