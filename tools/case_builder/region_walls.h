// SPDX-License-Identifier: GPL-3.0-or-later
// How thick and how stiff each region of a vessel's wall is: proposed for its size, and as an author changes it.
#pragma once
#include <string>
#include <vector>

#include "tools/artery/vessel.h"
#include "tools/case_builder/case_folder.h"

namespace insula::case_builder {

/// Thickness and Young's modulus of regions, for their membrane.
struct WallOf {
  std::string regions;  ///< separated by spaces
  double thickness_mm, young_mpa;
};

/// A value of a region in place of the proposed one.
struct WallChange {
  std::string region;     ///< neck, sac, bleb, a vessel, or "vessels": all of them
  std::string parameter;  ///< thickness or young
  std::string value;      ///< with its unit
};

/// "neck.young=7 MPa". The membrane's declaration says which values are allowed. Throws InputError.
WallChange read_wall_change(const std::string& text);

/// In SI units. Throws InputError, with `given` in its text, for a value that the membrane's declaration does not
/// allow.
double wall_value(const std::string& parameter, const std::string& value, const std::string& given);

/// Thickness as of real walls; the sac as stiff as lets it change its volume by some 6 % over a beat, whatever its
/// size; and what Options::walls says in place of that. Throws InputError for a region that the vessel has not.
std::vector<WallOf> walls_of(const artery::Vessel& vessel, const Options& options);

Json to_json(const std::vector<WallOf>& walls);
std::vector<WallOf> walls_from(const Json& json);

}  // namespace insula::case_builder
