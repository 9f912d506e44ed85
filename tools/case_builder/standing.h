// SPDX-License-Identifier: GPL-3.0-or-later
// How a scene stands when it begins: what the arms hold, how much of the sac the microscope sees, whether the hands
// start in the free. Lobes of an author's own may leave the arms in tissue or in the air, and the aneurysm covered;
// this finds out in the settled scene itself.
#pragma once
#include "core/mechanics/deformable_body.h"
#include "core/sim/simulation.h"
#include "tools/case_builder/case_folder.h"

namespace insula::case_builder {

/// A tool on a table-mounted arm.
struct StandingArm {
  std::string id, lobe;  ///< lobe: the soft body on which it presses most; empty: it touches none
  double force = 0;      ///< on that, N
  double deepest = 0;    ///< of its corners within a lobe or the floor, mm
};
/// A lobe that still moves.
struct RestlessLobe {
  std::string id;
  double speed = 0;  ///< of its fastest node, mm/s
};
struct Standing {
  std::vector<StandingArm> arms;
  bool arms_chosen = false;  ///< the author has placed them, and may want several on one lobe
  std::vector<RestlessLobe> restless;
  double seen = 1;  ///< of the sac's side that faces the microscope, the share that no lobe, bone or arm hides
  bool has_sac = false;
  std::vector<std::string> in_tissue;  ///< hands' tools that start within a lobe, the floor or the bone
};
/// Present places of a body's nodes, mm.
std::vector<Vec3> nodes_mm(const DeformableBody& body);
/// Of a scene that has been stepped at least once. Millimetres and newtons.
Standing standing_of(const Simulation& simulation);

/// What is to be told of it: facts where it is as it should be, problems with what to do where it is not.
std::vector<Note> judged(const Standing& standing);

}  // namespace insula::case_builder
