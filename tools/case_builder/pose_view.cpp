// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/case_builder/pose_view.h"

#include <algorithm>
#include <string>

#include "core/base/input_error.h"
#include "core/base/text.h"
#include "tools/case_builder/unit_options.h"
#include "tools/case_builder/wall.h"

namespace insula::case_builder {
namespace {

/// which: the room that counts, before or after the lobes are parted.
Json told(const Placement& p, const std::vector<Room>& rooms, double Room::*which, const Sight& sight) {
  Json out = {{"pose", motion_of(p)}, {"parted", false}};
  for (const char* name : {"rooms", "overlap_mm", "hidden_pct"}) out[name] = Json::object();
  for (const Room& r : rooms) {
    out["rooms"][r.what] = rounded(r.before);
    out["overlap_mm"][r.what] = rounded(std::max(0.0, -(r.*which)));
  }
  out["seen_pct"] = rounded(100 * sight.seen);
  for (const auto& [what, share] : sight.hidden) out["hidden_pct"][what] = rounded(100 * share);
  return out;
}

}  // namespace

PoseView::PoseView(const CaseFolder& folder, const fs::path& project, const Options& o)
    : vessel_(read_wall(folder.wall())),
      fissure_(with_retractors(read_fissure(project, o.brain.empty() ? fs::path(o.lobes) : folder.brain(),
                                            read_approach(project, o.approach)),
                               o)),
      built_(placement_from(read_json(folder.path / "place.json"))),
      gap_(o.gap) {
  if (!vessel_.neck) throw InputError("the vessel has no neck; do the stage wall again");
  for (const Lobe& lobe : fissure_.lobes) solids_.emplace_back(lobe.surface);
  solids_.emplace_back(fissure_.floor);
}

std::vector<Room> PoseView::rooms_of(const artery::Vessel& there) const {
  const Solid wall(there.wall.mesh);
  std::vector<Room> out;
  for (std::size_t k = 0; k < solids_.size(); ++k) {
    const double room = room_beside(solids_[k], wall);
    const bool lobe = k < fissure_.lobes.size();
    out.push_back({lobe ? fissure_.lobes[k].name : fissure_.approach.floor, room, room, 0});
  }
  return out;
}

Json PoseView::look(const Placement& p) const {
  const artery::Vessel there = placed(vessel_, p);
  return told(p, rooms_of(there), &Room::before, sight_of_neck(there, fissure_));
}

Json PoseView::look_parted(const Placement& p, const fs::path& folder) const {
  const artery::Vessel there = placed(vessel_, p);
  Fissure parted = fissure_;
  std::vector<Note> notes;
  Progress quiet;
  const std::vector<Room> all = part_lobes(parted, there.wall.mesh, gap_, notes, quiet);
  Json out = told(p, all, &Room::after, sight_of_neck(there, parted));
  out["parted"] = true;
  out["sound"] = is_sound(all);
  out["surfaces"] = Json::array();
  const auto write = [&](const std::string& name, const TriMesh& mesh) {
    write_ply(folder / ("parted_" + name + ".ply"), mesh, "unit mm");
    out["surfaces"].push_back(name);
  };
  for (const Lobe& lobe : parted.lobes) write(lobe.name, lobe.surface);
  write(parted.approach.floor, parted.floor);
  return out;
}

Json PoseView::write_surfaces(const fs::path& folder) const {
  std::vector<std::pair<std::string, const TriMesh*>> all{{"vessel", &vessel_.wall.mesh}};
  for (const Lobe& lobe : fissure_.lobes) all.emplace_back(lobe.name, &lobe.surface);
  all.emplace_back(fissure_.approach.floor, &fissure_.floor);
  all.emplace_back("retractors", &fissure_.retractors);
  all.emplace_back("retractor", &fissure_.blade);
  Json names = Json::array();
  for (const auto& [name, mesh] : all) {
    if (mesh->triangles.empty()) continue;
    write_ply(folder / (name + ".ply"), *mesh, "unit mm");
    if (mesh != &fissure_.blade) names.push_back(name);
  }
  const Approach& approach = fissure_.approach;
  return {{"surfaces", names},
          {"retractors",
           {{"proposed", to_json(fissure_.proposed)},
            {"lobes", approach.lobes},
            {"centre", to_json(approach.centre)},
            {"radius_mm", approach.radius},
            {"most", most_retractors},
            {"most_pull_mm", most_pull},
            {"most_lean_deg", most_lean}}},
          {"pose", motion_of(built_)},
          {"neck", to_json(vessel_.neck->centre)},
          {"neck_normal", to_json(vessel_.neck->normal)},
          {"to_surgeon", to_json(fissure_.approach.to_surgeon)}};
}

void answer_poses(const PoseView& view, const fs::path& surfaces, std::istream& in, std::FILE* out) {
  const auto tell = [out](const Json& json) {
    std::fprintf(out, "%s\n", json.dump().c_str());
    std::fflush(out);
  };
  tell(view.write_surfaces(surfaces));
  for (std::string line; std::getline(in, line);) {
    std::string_view text = trim(line);
    const bool part = text.starts_with("part ");
    if (part) text.remove_prefix(5);
    std::string why;
    const auto numbers = read_shape(text, Shape::motion, why);
    if (!numbers) {
      tell({{"error", why}});
      continue;
    }
    RigidMotion motion;
    std::copy(numbers->begin(), numbers->end(), motion.begin());
    tell(part ? view.look_parted(placement_of(motion), surfaces) : view.look(placement_of(motion)));
  }
}

}  // namespace insula::case_builder
