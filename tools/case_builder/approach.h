// SPDX-License-Identifier: GPL-3.0-or-later
// A surgical approach as data: which lobes it passes, where the neck lies, from where the surgeon looks, where hands
// and arms stand. It is declared once, in approach.json beside the approach's meshes (docs/approaches.md).
#pragma once
#include <array>
#include <string>
#include <vector>

#include "tools/case_builder/case_folder.h"

namespace insula::case_builder {

/// How an exercise looks at the field. What is a text stands in scenes as it is here, with its units.
struct ApproachView {
  std::string eye, target, up, field_of_view;
  Vec3 from_neck = Vec3::Zero();  ///< mm: of the point looked at, where `target` is empty
};
/// Where hands and blood of an exercise about the aneurysm are.
struct ApproachField {
  ApproachView view;
  std::string left, right;  ///< home, shaft and flat of the hand's tools
  std::string blood_up, blood_radius, blood_depth;
};
/// The exercise that opens the fissure. Empty texts: the approach has none.
struct ApproachOpening {
  std::string file, motion;  ///< names in the case and in the project; no motion: empty
  std::string id, comment, scene, title, text;
  ApproachView view;
  std::string left, right, strands_centre, strands_radius, opens_at, inward;
};

/// Millimetres in the frame of the meshes.
struct Approach {
  fs::path folder;  ///< of its meshes
  std::string name, title;
  Vec3 centre = Vec3::Zero();   ///< of the ball that is meshed
  double radius = 0, held = 0;  ///< of that ball; nodes farther out than `held` stay where they are
  std::array<std::string, 2> lobes;
  std::string floor;                   ///< rigid, behind the aneurysm
  std::vector<std::string> obstacles;  ///< the others that tools may meet: bone, falx
  Vec3 neck, sac_points, parent_arrives, to_surgeon;
  std::string closed_part, open_part, limits_part;  ///< files of scenes/parts
  std::vector<std::string> more_parts;              ///< files of scenes/parts which those include
  std::vector<std::string> rigid_folders;           ///< of meshes, which those name: bone, falx
  ApproachOpening opening;
  ApproachField dissection, clipping;
  Vec3 suction_shaft, suction_flat, suction_beside_neck;  ///< of the scripted tube in exercise 4

  std::array<std::string, 3> parts() const { return {lobes[0], lobes[1], floor}; }
};

/// The approach of that name among the project's meshes. Throws InputError, with the names that there are.
Approach read_approach(const fs::path& project, const std::string& name);

}  // namespace insula::case_builder
