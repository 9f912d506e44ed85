// SPDX-License-Identifier: GPL-3.0-or-later
// Stage 3: the wall is brought into the fissure by a rigid motion, and the lobes are parted where they would overlap
// it.
#pragma once
#include "tools/artery/vessel.h"
#include "tools/case_builder/case_folder.h"
#include "tools/case_builder/fissure.h"
#include "tools/case_builder/progress.h"
#include "tools/case_builder/solid.h"

namespace insula::case_builder {

inline constexpr double wall_half = 0.15;  ///< of the vessel's wall, mm

/// x' = rotation x + shift, mm.
struct Placement {
  Mat3 rotation = Mat3::Identity();
  Vec3 shift = Vec3::Zero();
  Vec3 apply(const Vec3& p) const { return rotation * p + shift; }
};
/// From an option and back, its rotation by half a turn at most.
Placement placement_of(const RigidMotion& motion);
RigidMotion motion_of(const Placement& placement);
/// As "rotation" (by rows) and "shift_mm".
void write_placement(const Placement& placement, Json& json);
Placement placement_from(const Json& json);

/// Placements near that of the approach, turned differently about the sac's axis, some with a sac that leans away from
/// the line of sight. The first has the least overlap of those that do not lean, the next that of each lean, and so on.
/// Each is found on a fixed grid of turns and shifts and then refined. One alone where the turn or the place is given.
std::vector<Placement> find_placements(const artery::Vessel& vessel, const Fissure& fissure, const Options& options,
                                       Progress& progress);

artery::Vessel placed(artery::Vessel vessel, const Placement& placement);

/// How far the wall's surface (its middle, less half its thickness) is from a surface; negative: they overlap.
struct Room {
  std::string what;
  double before = 0, after = 0;  ///< mm
  double moved = 0;              ///< farthest that a node was moved, mm
  double least_volume = 1;       ///< of a tetrahedron over what it was; the floor has none
};

/// How far a wall is from a surface of the fissure, as Room has it, mm.
double room_beside(const Solid& surface, const Solid& wall);

/// Whether nothing touches the wall.
bool is_clear(const std::vector<Room>& rooms);
/// Whether the lobes still are meshes: no element turned inside out, no node moved out of the fissure.
bool is_sound(const std::vector<Room>& rooms);

/// Parts the lobes elastically (and draws the floor back) until each is `gap` from the wall, each other no nearer than
/// they were.
std::vector<Room> part_lobes(Fissure& fissure, const TriMesh& wall, double gap, std::vector<Note>& notes,
                             Progress& progress);

/// The stage: reads wall/ and the project's fissure, writes artery/ and lobes/.
void run_place(const CaseFolder& folder, const fs::path& project, const Options& options, Progress& progress);

}  // namespace insula::case_builder
