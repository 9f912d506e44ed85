// SPDX-License-Identifier: GPL-3.0-or-later
// A closed wall for simulation, with named regions, caps and centrelines, in the format that tools/artery writes.
#pragma once
#include <filesystem>
#include <string>
#include <vector>

#include "core/model/mesh.h"

namespace insula {

/// Lengths in metres, positions in the frame of the files.
struct WallModel {
  struct Cap {
    std::string name;
    std::vector<int> triangles;  ///< of the wall, ascending
  };
  struct Centreline {
    std::string name;
    std::string region;          ///< one of `regions`
    std::string from, to;        ///< caps, "bifurcation", "dome"
    std::vector<Vec3> points;    ///< two or more, in flow direction
    std::vector<double> radius;  ///< one for each point, > 0
  };

  TriMesh wall;  ///< closed, facing outward, with caps; vertices numbered as in wall.ply
  std::vector<std::string> regions;
  std::vector<int> vertex_region;  ///< index into regions, one for each vertex
  std::vector<Cap> caps;
  std::vector<Centreline> centrelines;

  bool has_neck = false;                                         ///< not every wall has one
  Vec3 neck_centre = Vec3::Zero(), neck_normal = Vec3::UnitZ();  ///< unit, towards the dome
  double neck_diameter = 0;
  double dome_height = 0;  ///< above the neck's plane; 0 without a neck
  double bleb_radius = 0;  ///< 0 if there is no bleb
  Vec3 bleb_centre = Vec3::Zero();

  /// Index of a region, or -1.
  int region(const std::string& name) const;
};

/// Reads the JSON file and the wall.ply beside it. Throws InputError: unreadable, malformed, wrong unit, sizes that do
/// not match one another, indices out of range, names used twice, not finite, a wall that is open or faces inward.
WallModel read_wall(const std::filesystem::path& json_file);

}  // namespace insula
