// SPDX-License-Identifier: GPL-3.0-or-later
// A rigid tool read from URDF (urdfdom) plus the meshes it names and the tool.json beside it.
#pragma once
#include <array>
#include <filesystem>
#include <string>
#include <vector>

#include "core/model/mesh.h"

namespace insula {

/// All points within `radius` of the convex hull of `points` (tool frame, metres): 1 point a sphere, 2 a capsule, more a rounded hull.
struct ConvexPiece {
  std::string name;
  std::vector<Vec3> points;
  double radius = 0;
};

struct ToolPart {
  std::string name;
  std::string material;  ///< "steel", "polymer", ...
  std::array<double, 4> rgba{0.7, 0.7, 0.7, 1};
  TriMesh mesh;          ///< tool frame
};

struct ToolModel {
  std::string name;
  double mass = 0;                ///< kg
  Vec3 centre_of_mass = Vec3::Zero();
  Mat3 inertia = Mat3::Zero();    ///< kg m2 about the centre of mass, tool frame
  std::vector<ConvexPiece> pieces;   ///< contact model
  std::vector<ToolPart> parts;       ///< picture
  std::vector<std::array<Vec3, 2>> blade_edges;  ///< cutting edges, empty when the tool does not cut
  double tip_inner_radius = 0;       ///< suction opening, m
};

/// Frame: origin at the working tip, +z along the shaft to the handle, +x normal of the blade's flat side.
/// URDF cylinders are capsules (core segment length - 2 radius), spheres spheres, meshes the hull of their points.
/// Throws InputError: unreadable, mass not positive and finite, inertia not positive definite, missing or bad meshes,
/// no collision pieces, more than 24 points in a hull.
ToolModel read_tool(const std::filesystem::path& urdf);

}  // namespace insula
