// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/case_builder/scenes.h"

#include <fmt/format.h>

#include <algorithm>

#include "core/base/input_error.h"
#include "core/model/formats/file_bytes.h"
#include "tools/case_builder/clipping_rehearsal.h"
#include "tools/case_builder/dissection_script.h"
#include "tools/case_builder/opening_play.h"
#include "tools/case_builder/place.h"
#include "tools/case_builder/rupture_script.h"
#include "tools/case_builder/scene_text.h"
#include "tools/case_builder/wall.h"

namespace insula::case_builder {
namespace {

constexpr const char* temporary_clip = "temporary_straight";
const std::string later[] = {"2_aneurysm_dissection", "3_clipping", "4_rupture"};

/// Clips on the tray of a case: those for the neck first, then one of each kind.
std::vector<std::string> on_tray(const std::vector<std::string>& first) {
  std::vector<std::string> out = first;
  for (const char* menu : {"straight", "curved", "angled", "bayonet", "fenestrated_3_5_stem_90", "mini", temporary_clip,
                           "temporary_curved"})
    if (std::find(first.begin(), first.end(), menu) == first.end()) out.push_back(menu);
  return out;
}

SceneFacts facts_of(const CaseFolder& folder, const artery::Vessel& v, const Options& o, const Approach& approach) {
  SceneFacts f;
  f.approach = approach, f.opened = !approach.opening.motion.empty();
  f.name = folder.name;
  f.site = o.site, f.difficulty = o.difficulty;
  f.rules = rule_changes(o), f.folder = folder.path;
  f.temporary = temporary_clip;
  const Json wall = read_json(folder.wall() / "notes.json");
  f.walls = walls_from(wall.at("walls"));
  f.patches = patches_from(wall.value("patches", Json::array()));
  const Json place = read_json(folder.path / "place.json");
  const Placement to = placement_from(place);
  if (place.contains("retractors")) f.retractors = retractors_from(place["retractors"]);
  for (PatchOf& patch : f.patches)
    for (Vec3& spot : patch.spots) spot = to.apply(spot);
  for (const artery::NamedCurve& c : v.centrelines) {
    if (c.name == "sac") continue;
    f.tethered += (f.tethered.empty() ? "" : " ") + c.region;
    if (c.to.starts_with("outlet")) f.branches += (f.branches.empty() ? "" : " ") + c.name;
  }
  f.neck = v.neck->centre, f.dome = v.centrelines.back().curve.points.back();
  f.dome_reach = std::max(v.dome_height, v.neck->diameter);
  f.bleb = v.bleb.has_value();
  f.strand_sets = all_strand_sets(approach);
  return f;
}

void write_clipping(const SceneFacts& f, const CaseFolder& folder) {
  write_text(folder.path / "artery.xml", artery_part(f));
  if (f.retractors) write_text(folder.path / "retractors.xml", retractors_part(f));
  else fs::remove(folder.path / "retractors.xml");
  write_text(folder.path / "field.xml", field_part(f));
  write_text(exercise_file(folder, 3), exercise(f, 3));
}

/// What the scenes are made of, before anything is played.
struct Draft {
  Draft(const CaseFolder& folder, const fs::path& project, const Options& o)
      : vessel(read_wall(folder.artery())),
        clips(read_clips(project)),
        approach(read_approach(project, o.approach)),
        floor(read_ply(folder.lobes() / (approach.floor + "_surface.ply"))) {
    if (!vessel.neck) throw InputError("the vessel has no neck; do the stage wall again");
    ranked = clip_plans(vessel, floor, clips, o, approach);
    facts = facts_of(folder, vessel, o, approach);
    facts.clips = on_tray({ranked.front().clip.name});
    facts.assets = link_assets(folder, project, facts.clips, approach);
  }

  artery::Vessel vessel;
  std::vector<ClipShape> clips;
  Approach approach;
  Solid floor;
  std::vector<ClipPlan> ranked;  ///< the best first
  SceneFacts facts;              ///< with the clip of the best one
};

/// Whether the author says where the blades lie.
bool blades_are_given(const Options& o) { return o.lift && o.slide && o.turn; }

/// The best of the ranked plans in the running scene. A plan that an author has fixed is played, and left as it is.
RehearsedClip rehearsed_clip(const Draft& draft, const CaseFolder& folder, const fs::path& project,
                             const std::vector<ClipPlan>& ranked, const Options& o, int plays, Progress& progress) {
  constexpr std::size_t most_plans = 4;
  const bool fixed = blades_are_given(o);
  const std::vector<ClipPlan> tried = distinct_plans(ranked, fixed ? 1 : most_plans);
  std::vector<std::string> names;
  for (const ClipPlan& p : tried)
    if (std::find(names.begin(), names.end(), p.clip.name) == names.end()) names.push_back(p.clip.name);
  SceneFacts f = draft.facts;
  f.clips = on_tray(names);
  f.assets = link_assets(folder, project, f.clips, f.approach);
  write_clipping(f, folder);
  return rehearse_clipping(exercise_file(folder, 3), folder.path / "3_clipping_steady.csv", draft.vessel, tried, !fixed,
                           plays, progress);
}

/// The same. Where no placement is sound, plans with more care are played too, and taken if one of them is.
RehearsedClip sound_clip(const Draft& draft, const CaseFolder& folder, const fs::path& project, const Options& o,
                         Progress& progress) {
  progress.step("rehearsing the clipping");
  RehearsedClip out = rehearsed_clip(draft, folder, project, draft.ranked, o, o.plays, progress);
  if (out.outcome.sound() || blades_are_given(o)) return out;
  const std::vector<ClipPlan> careful_plans =
      clip_plans(draft.vessel, draft.floor, draft.clips, o, draft.approach, Care::more);
  RehearsedClip careful = rehearsed_clip(draft, folder, project, careful_plans, o, (o.plays + 1) / 2, progress);
  careful.plays += out.plays;
  return careful.outcome.sound() ? careful : out;
}

/// Throws InputError if a change of a rule is none that its declaration allows, before the long work.
void write_rules(const SceneFacts& f, const CaseFolder& folder) {
  Json all = Json::array();
  for (int k = folder.opening.empty() ? 2 : 1; k <= 4; ++k) {
    exercise(f, k);
    const fs::path file = exercise_file(folder, k);
    const std::string proposed = proposed_exercise(f, k);
    all.push_back({{"exercise", k},
                   {"file", file.filename().string()},
                   {"rules", rules_of(proposed, file)},
                   {"strands", strands_of(proposed, file)}});
  }
  write_json(folder.path / "rules.json", all);
}

}  // namespace

fs::path exercise_file(const CaseFolder& folder, int number) {
  return folder.path / ((number == 1 ? folder.opening : later[number - 2]) + ".xml");
}

std::vector<fs::path> exercise_files(const CaseFolder& folder) {
  std::vector<fs::path> out;
  for (int k = folder.opening.empty() ? 2 : 1; k <= 4; ++k) out.push_back(exercise_file(folder, k));
  return out;
}

fs::path write_draft(const CaseFolder& folder, const fs::path& project, const Options& o) {
  const Draft draft(folder, project, o);
  write_clipping(draft.facts, folder);
  write_text(folder.path / "3_clipping_steady.csv", clipping_motion(draft.ranked.front()));
  return exercise_file(folder, 3);
}

void run_scenes(const CaseFolder& folder, const fs::path& project, const Options& o, Progress& progress) {
  progress.stage("scenes", (o.brain.empty() ? 5 : 6) + (o.rehearse ? 2 : 1));
  progress.step("choosing a clip");
  Draft draft(folder, project, o);
  const artery::Vessel& v = draft.vessel;
  const Solid& floor = draft.floor;
  SceneFacts& f = draft.facts;
  std::vector<Note> notes;
  write_rules(f, folder);
  RehearsedClip clipped{draft.ranked.front(), {}, 0};
  if (o.rehearse) clipped = sound_clip(draft, folder, project, o, progress);
  const ClipPlan& plan = clipped.plan;
  const std::vector<Note> wrong = o.rehearse ? notes_of(clipped) : notes_of(plan);
  notes.insert(notes.end(), wrong.begin(), wrong.end());

  progress.step("writing the exercises");
  f.clips = on_tray({plan.clip.name});
  f.assets = link_assets(folder, project, f.clips, f.approach);
  write_clipping(f, folder);
  if (f.opened)
    write_text(folder.path / (f.approach.opening.file + "_steady.csv"),
               read_file_bytes(project / f.approach.opening.motion));
  write_text(folder.path / "3_clipping_steady.csv", clipping_motion(plan));
  const auto temporary =
      std::find_if(draft.clips.begin(), draft.clips.end(), [&](const ClipShape& c) { return c.name == f.temporary; });
  if (temporary == draft.clips.end()) throw InputError("the library has no clip " + f.temporary);
  const ApplierPose held = plan_temporary(v, floor, *temporary, draft.approach);

  spin_strands(f, folder, o.rehearse, notes, progress);
  write_rules(f, folder);  // with the strands that there are
  if (!o.brain.empty()) try_opening(f, folder, o.rehearse, notes, progress);
  script_rupture(folder, v, plan, held, f, o.rehearse, notes, progress);
  progress.step("writing");
  Json json;
  json["clip"] = {{"name", plan.clip.name},
                  {"blade_mm", rounded(plan.clip.blade)},
                  {"needed_mm", rounded(plan.needed)},
                  {"off_view_deg", rounded(plan.off_view)},
                  {"lift_mm", rounded(plan.at.lift)},
                  {"slide_mm", rounded(plan.at.slide)},
                  {"turn_deg", rounded(plan.at.turn)}};
  if (o.rehearse) json["clipping"] = to_json(clipped.outcome);
  json["clips"] = Json::array();
  for (const ClipShape& c : draft.clips)
    if (c.kind != "temporary" && c.kind != "mini_temporary")
      json["clips"].push_back({{"name", c.name}, {"blade_mm", rounded(c.blade)}});
  json["files_copied"] = f.assets.copied;
  json["notes"] = to_json(notes);
  write_json(folder.path / "scenes.json", json);
  progress.finish();
}

}  // namespace insula::case_builder
