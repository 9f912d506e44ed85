// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/case_builder/scenes.h"

#include <fmt/format.h>

#include <algorithm>

#include "core/base/input_error.h"
#include "core/model/formats/file_bytes.h"
#include "tools/case_builder/dissection_script.h"
#include "tools/case_builder/motion_script.h"
#include "tools/case_builder/opening_play.h"
#include "tools/case_builder/rupture_script.h"
#include "tools/case_builder/scene_text.h"
#include "tools/case_builder/wall.h"

namespace insula::case_builder {
namespace {

constexpr const char* names[] = {"1_sylvian_fissure", "2_aneurysm_dissection", "3_clipping", "4_rupture"};

std::string clipping_motion(const ClipPlan& plan) {
  MotionScript m;
  m.command(0.1, "applier load " + plan.clip.name);
  m.place_clip(plan.pose, out_of_field, 2.5);
  m.key(true, 8, drawn_back(plan.pose, out_of_field));
  return m.csv();
}

}  // namespace

std::vector<fs::path> exercise_files(const CaseFolder& folder) {
  std::vector<fs::path> out;
  for (const char* n : names) out.push_back(folder.path / (std::string(n) + ".xml"));
  return out;
}

void run_scenes(const CaseFolder& folder, const fs::path& project, const Options& o, Progress& progress) {
  progress.stage("scenes", (o.brain.empty() ? 5 : 6) + 1);
  progress.step("choosing a clip");
  const artery::Vessel v = read_wall(folder.artery());
  if (!v.neck) throw InputError("the vessel has no neck; do the stage wall again");
  std::vector<Note> notes;
  const std::vector<ClipShape> clips = read_clips(project);
  const Solid floor(read_ply(folder.lobes() / "insula_surface.ply"));
  const ClipPlan plan = plan_clip(v, floor, clips, o, notes);

  SceneFacts f;
  f.name = folder.name;
  f.site = o.site, f.difficulty = o.difficulty;
  f.temporary = "temporary_straight";
  f.clips = {plan.clip.name};
  for (const char* menu : {"straight", "curved", "angled", "bayonet", "fenestrated_3_5_stem_90", "mini",
                           "temporary_straight", "temporary_curved"})
    if (menu != plan.clip.name) f.clips.push_back(menu);
  f.assets = link_assets(folder, project, f.clips);
  const Json wall = read_json(folder.wall() / "notes.json");
  for (const Json& w : wall.at("walls")) f.walls.push_back({w.at("regions"), w.at("thickness_mm"), w.at("young_MPa")});
  for (const artery::NamedCurve& c : v.centrelines) {
    if (c.name == "sac") continue;
    f.tethered += (f.tethered.empty() ? "" : " ") + c.region;
    if (c.to.starts_with("outlet")) f.branches += (f.branches.empty() ? "" : " ") + c.name;
  }
  f.neck = v.neck->centre, f.dome = v.centrelines.back().curve.points.back();
  f.dome_reach = std::max(v.dome_height, v.neck->diameter);
  f.bleb = v.bleb.has_value();

  progress.step("writing the exercises");
  write_text(folder.path / "artery.xml", artery_part(f));
  write_text(folder.path / "field.xml", field_part(f));
  write_text(folder.path / "1_sylvian_fissure_steady.csv",
             read_file_bytes(project / "scenes/training/1_sylvian_fissure_steady.csv"));
  write_text(folder.path / "3_clipping_steady.csv", clipping_motion(plan));
  const auto temporary =
      std::find_if(clips.begin(), clips.end(), [&](const ClipShape& c) { return c.name == f.temporary; });
  if (temporary == clips.end()) throw InputError("the library has no clip " + f.temporary);
  const ApplierPose held = plan_temporary(v, floor, *temporary);

  spin_strands(f, folder, o.rehearse, notes, progress);
  if (!o.brain.empty()) try_opening(f, folder, o.rehearse, notes, progress);
  script_rupture(folder, v, plan, held, f.temporary, o.rehearse, notes, progress);
  progress.step("writing");
  Json json;
  json["clip"] = {{"name", plan.clip.name},
                  {"blade_mm", rounded(plan.clip.blade)},
                  {"needed_mm", rounded(plan.needed)},
                  {"off_view_deg", rounded(plan.off_view)},
                  {"lift_mm", rounded(plan.lift)},
                  {"slide_mm", rounded(plan.slide)},
                  {"turn_deg", rounded(plan.turn)}};
  json["files_copied"] = f.assets.copied;
  json["notes"] = to_json(notes);
  write_json(folder.path / "scenes.json", json);
  progress.finish();
}

}  // namespace insula::case_builder
