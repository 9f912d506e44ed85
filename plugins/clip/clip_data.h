// SPDX-License-Identifier: GPL-3.0-or-later
// The section "clip" of a tool.json: the data of an aneurysm clip with two jaws.
//   "clip": {"kind": "permanent", "shape": "straight", "blade_length_mm": 9, "blade_width_mm": 1.2,
//            "closing_force_N": 1.7, "force_slope_N_per_m": 350, "reference_mm": 11, "friction": 0.3,
//            "blade_from": [x,y,z], "blade_to": [x,y,z], "blade_line": [[x,y,z], ...],
//            "grip": {"position": [x,y,z], "shaft": [x,y,z], "flat": [x,y,z]},
//            "fenestration": {"centre": [x,y,z], "axis": [x,y,z], "diameter_mm": 5}}
// blade_line and fenestration are optional.
#pragma once
#include <optional>
#include <string>
#include <vector>

#include "core/model/tools/tool_model.h"

namespace insula {

/// The window of a fenestrated clip: a round hole between the closed jaws.
struct Fenestration {
  Vec3 centre = Vec3::Zero();
  Vec3 axis = Vec3::UnitY();  ///< unit
  double radius = 0;          ///< m
};

/// Data of an aneurysm clip: two jaws that a spring presses together. Tool frame, at opening 0, SI units.
struct ClipData {
  std::string kind;              ///< "permanent", "temporary", "mini", "mini_temporary"
  std::string shape;             ///< "straight", "curved", ...
  double blade_length = 0;       ///< along the clamping line, m
  double blade_width = 0;        ///< m
  double closing_force = 0;      ///< between the blades at the reference point when closed, N
  double force_slope = 0;        ///< rise per metre of opening between the blades at the reference point, N/m
  double reference = 0;          ///< distance from the hinge axis to the reference point, the middle of the blade, m
  double friction = 0;           ///< of the clamping faces
  Pose grip;                     ///< of the applier: origin between its jaws, +z along its shaft
  std::vector<Vec3> blade_line;  ///< clamping line from the root to the tip, two points or more
  Vec3 blade_from = Vec3::Zero(), blade_to = Vec3::Zero();  ///< its ends: root and tip
  std::optional<Fenestration> fenestration;
  bool temporary() const { return kind.find("temporary") != std::string::npos; }

  /// Gap between the blades at the reference point, m: 2 reference sin(opening).
  double gap(double opening) const;
  /// Moment of the spring on each jaw about the hinge, N m. The clamping force at the distance r from the hinge is
  /// torque / r.
  double torque(double opening) const;
};

/// Returns nothing if the tool's tool.json has no "clip". Throws InputError: malformed, not finite, out of range, not
/// two jaws.
std::optional<ClipData> read_clip_data(const ToolModel& tool);

}  // namespace insula
