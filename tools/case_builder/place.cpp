// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/case_builder/place.h"

#include <fmt/format.h>

#include <algorithm>
#include <numbers>

#include "core/base/input_error.h"
#include "tools/case_builder/approach.h"
#include "tools/case_builder/brain.h"
#include "tools/case_builder/clip_plan.h"
#include "tools/case_builder/wall.h"
#include "tools/mesh_lobes/mesh_data.h"

namespace insula::case_builder {
namespace {

void write_lobe(const fs::path& folder, const Lobe& lobe) {
  mesh_tool::TetMesh out;
  for (const Vec3& p : lobe.tets.nodes) out.points.push_back({p.x(), p.y(), p.z()});
  for (const auto& t : lobe.tets.tets) out.tets.push_back({t[0], t[1], t[2], t[3]});
  fs::create_directories(folder);
  mesh_tool::write_msh((folder / (lobe.name + ".msh")).string(), out, mesh_tool::MshFormat::v2_ascii);
  write_ply(folder / (lobe.name + "_surface.ply"), lobe.surface, "unit mm; a lobe parted for a vessel");
}

constexpr double per_degree = std::numbers::pi / 180;
constexpr double easy = 2.5;  // of a plan's cost, below which a place is taken as the search ranks it

/// A placement, and the clip that seems to fit best there. Parting the lobes is the long work, so it comes later.
struct Candidate {
  Placement placement;
  artery::Vessel vessel;
  ClipPlan plan;
  bool promises() const { return !plan.leaves_remnant() && !plan.meets_dome() && plan.cost < easy; }
};

/// Those that promise an easy clip in the order of the search, then the others by what their clip costs.
std::vector<Candidate> candidates(const artery::Vessel& v, const std::vector<Placement>& placements,
                                  const Fissure& fissure, const std::vector<ClipShape>& clips, const Options& o) {
  std::vector<Candidate> out;
  const Solid floor(fissure.floor);
  for (const Placement& p : placements) {
    artery::Vessel there = placed(v, p);
    ClipPlan plan = clip_plans(there, floor, clips, o, fissure.approach).front();
    out.push_back({p, std::move(there), std::move(plan)});
  }
  std::stable_sort(out.begin(), out.end(), [](const Candidate& a, const Candidate& b) {
    if (a.promises() || b.promises()) return a.promises() && !b.promises();
    return a.plan.cost < b.plan.cost;
  });
  return out;
}

/// A placement with the lobes parted for it.
struct Fitted {
  Placement placement;
  artery::Vessel vessel;
  Fissure fissure;
  std::vector<Room> rooms;
  std::vector<Note> notes;
  bool settles() const { return is_sound(rooms) && is_clear(rooms); }
  double least_room() const {
    return std::min_element(rooms.begin(), rooms.end(), [](const Room& a, const Room& b) { return a.after < b.after; })
        ->after;
  }
  bool better_than(const Fitted& other) const {
    if (is_sound(rooms) != is_sound(other.rooms)) return is_sound(rooms);
    if (is_clear(rooms) != is_clear(other.rooms)) return is_clear(rooms);
    return least_room() > other.least_room();
  }
};

Fitted fitted(const Candidate& c, const Fissure& fissure, const Options& o, Progress& progress) {
  Fitted out{c.placement, c.vessel, fissure, {}, {}};
  out.rooms = part_lobes(out.fissure, out.vessel.wall.mesh, o.gap, out.notes, progress);
  return out;
}

/// Where a blade would stand in what does not give way to it.
void add_retractor_notes(const std::vector<RetractorAt>& all, const Fitted& fitted, std::vector<Note>& notes) {
  const Solid floor(fitted.fissure.floor), wall(fitted.vessel.wall.mesh);
  for (std::size_t k = 0; k < all.size(); ++k) {
    const TriMesh blade = at_place(fitted.fissure.blade, all[k]);
    const auto tell = [&](const Solid& in, const std::string& what, double allowed) {
      double deepest = 0;
      for (const Vec3& p : blade.vertices)
        if (const Nearest n = in.nearest(p, 12); n.found) deepest = std::max(deepest, -n.distance);
      if (deepest > allowed)
        notes.push_back(problem(
            "retractor_in_" + what,
            fmt::format("Retractor {} ({} lobe) stands {:.1f} mm deep in the {}.", k + 1, all[k].lobe, deepest, what),
            "Draw it back or move it aside (--retractor)."));
    };
    tell(floor, fitted.fissure.approach.floor, 1.5);
    tell(wall, "vessel", 0);
  }
}

}  // namespace

Placement placement_of(const RigidMotion& m) {
  Placement p;
  p.rotation = from_rotation_vector(per_degree * Vec3(m[3], m[4], m[5])).toRotationMatrix();
  p.shift = {m[0], m[1], m[2]};
  return p;
}

RigidMotion motion_of(const Placement& p) {
  const Vec3 turn = rotation_vector(Quat(p.rotation)) / per_degree;
  return {p.shift.x(), p.shift.y(), p.shift.z(), turn.x(), turn.y(), turn.z()};
}

void write_placement(const Placement& p, Json& json) {
  json["rotation"] = Json::array();
  for (int k = 0; k < 9; ++k) json["rotation"].push_back(rounded(p.rotation(k / 3, k % 3)));
  json["shift_mm"] = to_json(p.shift);
}

Placement placement_from(const Json& json) {
  Placement p;
  for (int k = 0; k < 9; ++k) p.rotation(k / 3, k % 3) = json.at("rotation").at(std::size_t(k)).get<double>();
  p.shift = vec3_from(json.at("shift_mm"));
  return p;
}

void run_place(const CaseFolder& folder, const fs::path& project, const Options& o, Progress& progress) {
  progress.stage("place", 5);
  progress.step("reading the fissure");
  const artery::Vessel v = read_wall(folder.wall());
  const Approach approach = read_approach(project, o.approach);
  const Fissure fissure =
      with_retractors(read_fissure(project, o.brain.empty() ? fs::path(o.lobes) : folder.brain(), approach), o);
  // A vessel that lies in the frame of the author's own brain goes where that went.
  const std::vector<Placement> all = o.in_place && !o.pose && !o.brain.empty()
                                         ? std::vector<Placement>{brain_motion(folder)}
                                         : find_placements(v, fissure, o, progress);
  progress.step("parting the lobes");
  const std::vector<Candidate> ranked = candidates(v, all, fissure, read_clips(project), o);
  Fitted best = fitted(ranked.front(), fissure, o, progress);
  for (std::size_t k = 1; k < ranked.size() && !best.settles(); ++k)
    if (Fitted next = fitted(ranked[k], fissure, o, progress); next.better_than(best)) best = std::move(next);
  if (!is_sound(best.rooms) && o.pose)
    throw InputError(
        "the vessel cannot lie where --pose moves it: the lobes would have to be crushed. Move it to where it overlaps "
        "them less");
  if (!is_sound(best.rooms))
    throw InputError(fmt::format(
        "the vessel has no place in this fissure: its dome is {:.1f} mm high, and the lobes would have to be "
        "crushed in each of {} placements. Keep less of the vessel (--keep), or give a brain with a wider "
        "fissure (--brain)",
        v.dome_height, all.size()));
  progress.step("writing");
  artery::write_vessel(best.vessel, folder.artery());
  for (const Lobe& lobe : best.fissure.lobes) write_lobe(folder.lobes(), lobe);
  write_ply(folder.lobes() / (approach.floor + "_surface.ply"), best.fissure.floor,
            "unit mm; the floor of the fissure");
  Json json;
  write_placement(best.placement, json);
  json["rooms"] = Json::array();
  for (const Room& r : best.rooms)
    json["rooms"].push_back({{"what", r.what},
                             {"before_mm", rounded(r.before)},
                             {"after_mm", rounded(r.after)},
                             {"moved_mm", rounded(r.moved)}});
  if (o.retractors) {
    const std::vector<RetractorAt> all_retractors = retractors_of(o, fissure);
    json["retractors"] = to_json(all_retractors);
    add_retractor_notes(all_retractors, best, best.notes);
  }
  json["notes"] = to_json(best.notes);
  write_json(folder.path / "place.json", json);
  progress.finish();
}

}  // namespace insula::case_builder
