// SPDX-License-Identifier: GPL-3.0-or-later
// A vessel that an author moves in the fissure: how far it overlaps what is there, and how its neck is seen, again and
// again for other poses.
#pragma once
#include <cstdio>
#include <istream>
#include <optional>

#include "tools/case_builder/fissure.h"
#include "tools/case_builder/place.h"
#include "tools/case_builder/sight.h"

namespace insula::case_builder {

class PoseView {
 public:
  /// Reads what the case's stages wall and brain have written, and the approach's fissure. Throws InputError.
  PoseView(const CaseFolder& folder, const fs::path& project, const Options& options);

  /// Of the lobes and the floor, before anything is parted: the numbers "before_mm" of place.json.
  std::vector<Room> rooms(const Placement& placement) const { return rooms_of(placed(vessel_, placement)); }
  /// {pose, parted: false, rooms: {NAME: mm}, overlap_mm: {NAME: mm}, seen_pct, hidden_pct: {NAME: %}}
  Json look(const Placement& placement) const;
  /// With the lobes parted, as the stage place would part them: overlap_mm is then that of report.json, and the neck is
  /// seen between the parted lobes. parted is true, and sound says whether no lobe is crushed. Lobes and floor as they
  /// then are go to `folder` as parted_NAME.ply, and surfaces has their names. Takes seconds.
  Json look_parted(const Placement& placement, const fs::path& folder) const;
  /// Surfaces for a picture, NAME.ply: "vessel" in its own frame, the others in that of the approach.
  /// "retractor" is one blade, as at_place() takes it. Gives {surfaces: [NAME], pose of the built case, neck: point in
  /// the vessel's frame, eye, retractors: {proposed, lobes, limits}}.
  Json write_surfaces(const fs::path& folder) const;

 private:
  std::vector<Room> rooms_of(const artery::Vessel& there) const;

  artery::Vessel vessel_;
  Fissure fissure_;
  std::vector<Solid> solids_;  ///< of the lobes, then the floor
  Placement built_;
  double gap_;
};

/// Answers each line of `in`, a pose "X Y Z mm RX RY RZ deg" or the same after the word "part", with a line of JSON,
/// until its end. The first line of the output tells what was written to `surfaces`, a folder.
void answer_poses(const PoseView& view, const fs::path& surfaces, std::istream& in, std::FILE* out);

}  // namespace insula::case_builder
