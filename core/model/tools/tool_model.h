// SPDX-License-Identifier: GPL-3.0-or-later
// A tool read from URDF (urdfdom), the meshes that it names, and the tool.json beside it. It is rigid, or one common
// angle rotates its links about hinges (jaws).
#pragma once
#include <array>
#include <filesystem>
#include <map>
#include <string>
#include <vector>

#include "core/model/mesh.h"

namespace insula {

/// All points within `radius` of the convex hull of `points` (tool frame, metres): a sphere for 1 point, a capsule for
/// 2, a rounded hull for more.
struct ConvexPiece {
  std::string name;
  std::vector<Vec3> points;
  double radius = 0;
  int link = 0;  ///< 0: the root; k > 0: rotates about hinges[k-1]
};

struct ToolPart {
  std::string name;
  std::string material;  ///< "steel", "polymer", ...
  std::array<double, 4> rgba{0.7, 0.7, 0.7, 1};
  TriMesh mesh;  ///< tool frame, at opening 0
  int link = 0;
};

/// Hinge of a link, which rotates by multiplier * opening about the axis, right-handed.
struct Hinge {
  Vec3 origin = Vec3::Zero();  ///< tool frame, at opening 0
  Vec3 axis = Vec3::UnitY();   ///< unit
  double multiplier = 1;
};

struct ToolModel {
  std::string name;
  double mass = 0;                               ///< kg, all links
  Vec3 centre_of_mass = Vec3::Zero();            ///< at opening 0
  Mat3 inertia = Mat3::Zero();                   ///< kg m2 about the centre of mass, tool frame, at opening 0
  std::vector<ConvexPiece> pieces;               ///< contact model
  std::vector<ToolPart> parts;                   ///< drawn meshes
  std::vector<Hinge> hinges;                     ///< of links 1, 2, ...; empty when the tool is rigid
  double opening_min = 0, opening_max = 0;       ///< rad
  std::vector<std::array<Vec3, 2>> blade_edges;  ///< cutting edges, empty when the tool does not cut
  double tip_inner_radius = 0;                   ///< suction opening, m
  std::map<std::string, std::string> sections;   ///< other sections of tool.json: JSON text by key, for plugins
  std::filesystem::path json_file;               ///< tool.json, for messages about a section; empty: none

  /// Motion of a link's points, tool frame to tool frame. It is the identity for the root and at opening 0.
  Pose link_pose(int link, double opening) const;
};

/// Frame: origin at the working tip, +z along the shaft to the handle, +x normal of the blade's flat side. URDF
/// cylinders are capsules (core segment length - 2 radius), spheres are spheres, meshes are the hulls of their points.
/// Links are the root and links attached to it by revolute joints. All joints but one <mimic> that one, whose angle is
/// the opening. Link 1 belongs to the driving joint. The others follow in the order of their joints' names.
/// Throws InputError: unreadable, mass not positive and finite, inertia not positive definite, missing or bad meshes,
/// no collision pieces, more than 24 points in a hull, joints of another kind, deeper trees, independent joints.
ToolModel read_tool(const std::filesystem::path& urdf);

}  // namespace insula
