// SPDX-License-Identifier: GPL-3.0-or-later
// A tool read from URDF (urdfdom) plus the meshes it names and the tool.json beside it: rigid, or with links that one
// common angle turns about hinges (the jaws of a clip).
#pragma once
#include <array>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "core/model/mesh.h"

namespace insula {

/// All points within `radius` of the convex hull of `points` (tool frame, metres): 1 point a sphere, 2 a capsule, more a rounded hull.
struct ConvexPiece {
  std::string name;
  std::vector<Vec3> points;
  double radius = 0;
  int link = 0;          ///< 0: the root; k > 0: turned about hinges[k-1]
};

struct ToolPart {
  std::string name;
  std::string material;  ///< "steel", "polymer", ...
  std::array<double, 4> rgba{0.7, 0.7, 0.7, 1};
  TriMesh mesh;          ///< tool frame, at opening 0
  int link = 0;
};

/// Where a link turns: by multiplier * opening about the axis, right-handed.
struct Hinge {
  Vec3 origin = Vec3::Zero();  ///< tool frame, at opening 0
  Vec3 axis = Vec3::UnitY();   ///< unit
  double multiplier = 1;
};

/// The window of a fenestrated clip: a round hole between the closed jaws.
struct Fenestration {
  Vec3 centre = Vec3::Zero();
  Vec3 axis = Vec3::UnitY();  ///< unit
  double radius = 0;          ///< m
};

/// What makes a tool an aneurysm clip: two jaws that a spring presses together. Tool frame, at opening 0, SI units.
struct ClipData {
  std::string kind;          ///< "permanent", "temporary", "mini", "mini_temporary"
  std::string shape;         ///< "straight", "curved", ...
  double blade_length = 0;   ///< along the clamping line, m
  double blade_width = 0;    ///< m
  double closing_force = 0;  ///< between the blades at the reference point when closed, N
  double force_slope = 0;    ///< rise per metre of opening between the blades at the reference point, N/m
  double reference = 0;      ///< distance from the hinge axis to the reference point, the middle of the blade, m
  double friction = 0;       ///< of the clamping faces
  Pose grip;                 ///< of the applier: origin between its jaws, +z along its shaft
  std::vector<Vec3> blade_line;  ///< clamping line from the root to the tip, two points or more
  Vec3 blade_from = Vec3::Zero(), blade_to = Vec3::Zero();  ///< its ends: root and tip
  std::optional<Fenestration> fenestration;

  /// Gap between the blades at the reference point, m: 2 reference sin(opening).
  double gap(double opening) const;
  /// Moment of the spring on each jaw about the hinge, N m. The clamping force at the distance r from the hinge is torque / r.
  double torque(double opening) const;
};

struct ToolModel {
  std::string name;
  double mass = 0;                ///< kg, all links
  Vec3 centre_of_mass = Vec3::Zero();  ///< at opening 0
  Mat3 inertia = Mat3::Zero();    ///< kg m2 about the centre of mass, tool frame, at opening 0
  std::vector<ConvexPiece> pieces;   ///< contact model
  std::vector<ToolPart> parts;       ///< picture
  std::vector<Hinge> hinges;         ///< of links 1, 2, ...; empty when the tool is rigid
  double opening_min = 0, opening_max = 0;  ///< rad
  std::vector<std::array<Vec3, 2>> blade_edges;  ///< cutting edges, empty when the tool does not cut
  double tip_inner_radius = 0;       ///< suction opening, m
  std::optional<ClipData> clip;

  int link_count() const { return 1 + int(hinges.size()); }
  /// Where the points of a link go, tool frame to tool frame: the identity for the root and at opening 0.
  Pose link_pose(int link, double opening) const;
};

/// Frame: origin at the working tip, +z along the shaft to the handle, +x normal of the blade's flat side.
/// URDF cylinders are capsules (core segment length - 2 radius), spheres spheres, meshes the hull of their points.
/// Links: the root and links hung on it by revolute joints; all but one <mimic> that one, whose angle is the opening.
/// Link 1 belongs to the driving joint, the others follow in the order of their joints' names.
/// Throws InputError: unreadable, mass not positive and finite, inertia not positive definite, missing or bad meshes,
/// no collision pieces, more than 24 points in a hull, joints of another kind, deeper trees, independent joints.
ToolModel read_tool(const std::filesystem::path& urdf);

}  // namespace insula
