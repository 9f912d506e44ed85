// SPDX-License-Identifier: GPL-3.0-or-later
// A vessel as made by tools/artery: wall surface with named regions, the caps that close it, and its centrelines.
#pragma once
#include <filesystem>
#include <string>
#include <vector>

#include "core/model/mesh.h"

namespace insula {

struct VesselModel {
  TriMesh wall;                           ///< watertight, caps included; m, scene frame
  std::vector<std::string> regions;       ///< names, unique
  std::vector<int> vertex_region;         ///< one a vertex
  struct Cap {
    std::string name;                     ///< "inlet", "superior_outlet", ...
    std::vector<int> triangles;           ///< of `wall`
  };
  std::vector<Cap> caps;
  struct Centreline {
    std::string name, region, from, to;   ///< from and to: names of caps or of junctions
    std::vector<Vec3> points;             ///< m
    std::vector<double> radius;           ///< of the lumen at each point, m
  };
  std::vector<Centreline> centrelines;
  Vec3 neck_centre = Vec3::Zero(), neck_normal = Vec3::UnitZ();  ///< the normal points to the dome
  double neck_diameter = 0;               ///< m; 0: the vessel has no aneurysm
  double dome_height = 0;                 ///< m
  Vec3 bleb_centre = Vec3::Zero();
  double bleb_radius = 0;                 ///< m
};

/// Reads vessel.json and the surface beside it. Checks sizes, indices, finiteness, names, closedness; throws InputError.
VesselModel read_vessel(const std::filesystem::path& json);

}  // namespace insula
