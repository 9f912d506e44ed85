// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/case_builder/place.h"

#include <fmt/format.h>

#include "core/base/input_error.h"
#include "tools/case_builder/brain.h"
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

}  // namespace

void run_place(const CaseFolder& folder, const fs::path& project, const Options& o, Progress& progress) {
  progress.stage("place", 5);
  progress.step("reading the fissure");
  const artery::Vessel v = read_wall(folder.wall());
  Fissure fissure = read_fissure(project, o.brain.empty() ? fs::path(o.lobes) : folder.brain());
  std::vector<Note> notes;
  // A vessel that lies in the frame of the author's own brain goes where that went.
  const Placement p = o.in_place && !o.brain.empty() ? brain_motion(folder) : find_placement(v, fissure, o, progress);
  const artery::Vessel there = placed(v, p);
  progress.step("parting the lobes");
  const std::vector<Room> rooms = part_lobes(fissure, there.wall.mesh, o.gap, notes, progress);
  progress.step("writing");
  artery::write_vessel(there, folder.artery());
  for (const Lobe& lobe : fissure.lobes) write_lobe(folder.lobes(), lobe);
  write_ply(folder.lobes() / "insula_surface.ply", fissure.insula, "unit mm; the floor of the fissure");
  Json json;
  json["rotation"] = Json::array();
  for (int r = 0; r < 3; ++r)
    for (int c = 0; c < 3; ++c) json["rotation"].push_back(rounded(p.rotation(r, c)));
  json["shift_mm"] = to_json(p.shift);
  json["rooms"] = Json::array();
  for (const Room& r : rooms)
    json["rooms"].push_back({{"what", r.what},
                             {"before_mm", rounded(r.before)},
                             {"after_mm", rounded(r.after)},
                             {"moved_mm", rounded(r.moved)}});
  json["notes"] = to_json(notes);
  write_json(folder.path / "place.json", json);
  progress.finish();
}

}  // namespace insula::case_builder
