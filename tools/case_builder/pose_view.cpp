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

Json overlaps(const std::vector<Room>& rooms, double Room::*which) {
  Json out = Json::object();
  for (const Room& r : rooms) out[r.what] = rounded(std::max(0.0, -(r.*which)));
  return out;
}

}  // namespace

PoseView::PoseView(const CaseFolder& folder, const fs::path& project, const Options& o)
    : vessel_(read_wall(folder.wall())),
      fissure_(read_fissure(project, o.brain.empty() ? fs::path(o.lobes) : folder.brain(),
                            read_approach(project, o.approach))),
      built_(placement_from(read_json(folder.path / "place.json"))),
      gap_(o.gap) {
  if (!vessel_.neck) throw InputError("the vessel has no neck; do the stage wall again");
  for (const Lobe& lobe : fissure_.lobes) solids_.emplace_back(lobe.surface);
  solids_.emplace_back(fissure_.floor);
}

std::vector<Room> PoseView::rooms(const Placement& p) const {
  const Solid wall(placed(vessel_, p).wall.mesh);
  std::vector<Room> out;
  for (std::size_t k = 0; k < solids_.size(); ++k) {
    const double room = room_beside(solids_[k], wall);
    const bool lobe = k < fissure_.lobes.size();
    out.push_back({lobe ? fissure_.lobes[k].name : fissure_.approach.floor, room, room, 0});
  }
  return out;
}

Json PoseView::look(const Placement& p) const {
  const std::vector<Room> all = rooms(p);
  const Sight sight = sight_of_neck(placed(vessel_, p), fissure_);
  Json out = {{"pose", motion_of(p)}, {"parted", false}, {"rooms", Json::object()}};
  for (const Room& r : all) out["rooms"][r.what] = rounded(r.before);
  out["overlap_mm"] = overlaps(all, &Room::before);
  out["seen_pct"] = rounded(100 * sight.seen);
  out["hidden_pct"] = Json::object();
  for (const auto& [what, share] : sight.hidden) out["hidden_pct"][what] = rounded(100 * share);
  return out;
}

Json PoseView::look_parted(const Placement& p) const {
  Json out = look(p);
  Fissure parted = fissure_;
  std::vector<Note> notes;
  Progress quiet;
  const std::vector<Room> all = part_lobes(parted, placed(vessel_, p).wall.mesh, gap_, notes, quiet);
  out["parted"] = true;
  out["sound"] = is_sound(all);
  out["overlap_mm"] = overlaps(all, &Room::after);
  return out;
}

Json PoseView::write_surfaces(const fs::path& folder) const {
  std::vector<std::pair<std::string, const TriMesh*>> all{{"vessel", &vessel_.wall.mesh}};
  for (const Lobe& lobe : fissure_.lobes) all.emplace_back(lobe.name, &lobe.surface);
  all.emplace_back(fissure_.approach.floor, &fissure_.floor);
  all.emplace_back("retractors", &fissure_.retractors);
  Json names = Json::array();
  for (const auto& [name, mesh] : all) {
    write_ply(folder / (name + ".ply"), *mesh, "unit mm");
    names.push_back(name);
  }
  return {{"surfaces", names},
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
    tell(part ? view.look_parted(placement_of(motion)) : view.look(placement_of(motion)));
  }
}

}  // namespace insula::case_builder
