// SPDX-License-Identifier: GPL-3.0-or-later
// Parts of a vessel's wall that an author paints: a plaque that is stiff, a spot that is thin. Each becomes a membrane
// with spots (plugins/membrane).
#pragma once
#include <string>
#include <vector>

#include "tools/artery/vessel.h"
#include "tools/case_builder/case_folder.h"

namespace insula::case_builder {

/// "12 3 4 mm, 12.5 3 4 mm, radius=1.2 mm, young=7 MPa": points, then what is changed. The membrane's declaration says
/// which values are allowed. Throws InputError.
WallPatch read_wall_patch(const std::string& text);

/// A patch on the wall that was made, in the frame of its vessel.
struct PatchOf {
  std::vector<Vec3> spots;  ///< mm
  double radius_mm, thickness_mm, young_mpa;
};

/// The patches on a wall. Points that are off it, since their part of the vessel was cut off, are left out, with a
/// note. Values that are not given are those of the region at the first point. Options as as_read() gives them.
std::vector<PatchOf> patches_of(const artery::Vessel& vessel, const Options& options, std::vector<Note>& notes);

Json to_json(const std::vector<PatchOf>& patches);
std::vector<PatchOf> patches_from(const Json& json);

}  // namespace insula::case_builder
