// SPDX-License-Identifier: GPL-3.0-or-later
// The table of dimensions that an artery is made from.
#pragma once
#include <filesystem>
#include <string>
#include <vector>

#include "core/base/math.h"

namespace insula::artery {

struct VesselSpec {
  std::vector<Vec3> points;
  double first_diameter = 0, last_diameter = 0;
};

struct CaseSpec {
  std::string name, about;
  VesselSpec parent, superior, inferior;
  double neck = 0, dome_height = 0, width = 0;  ///< of the sac
  Vec3 projection = Vec3::UnitX();              ///< unit, bifurcation to dome
  double bleb_diameter = 0, bleb_tilt = 0;      ///< tilt in rad from the projection
  Vec3 bleb_towards = Vec3::UnitZ();
};

/// Throws InputError: unreadable, malformed, names that are no folder names, dimensions that make no aneurysm.
std::vector<CaseSpec> read_case_table(const std::filesystem::path& file);

}  // namespace insula::artery
