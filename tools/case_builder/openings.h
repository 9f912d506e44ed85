// SPDX-License-Identifier: GPL-3.0-or-later
// The ends of a vessel: round borders are closed by flat caps, small holes are filled, planes cut ends where the author
// wants them.
#pragma once
#include "tools/artery/surface.h"
#include "tools/case_builder/case_folder.h"

namespace insula::case_builder {

/// A hole that is neither a round, flat end of a vessel nor small: a torn end, or a part of the wall that is missing.
struct TornBorder {
  Vec3 centre = Vec3::Zero();
  double radius = 0, perimeter = 0;  ///< radius: of the circle of equal area
  bool narrow = false;               ///< much narrower than the largest border
};
struct ClosedSurface {
  artery::Surface surface;
  std::vector<TornBorder> torn;  ///< filled, and part of the wall
};

/// Closes every border of an agreeing, two-sided surface, and turns it outward. Round and nearly flat borders become
/// caps; holes much smaller than those are filled. Every repair is noted.
ClosedSurface closed_surface(const TriMesh& mesh, std::vector<Note>& notes);

/// For torn borders that are still in the wall, since no end of a vessel was cut off there. Narrow ones are noted.
/// Throws InputError for others.
void check_torn(const artery::Surface& surface, const std::vector<TornBorder>& torn, std::vector<Note>& notes);

/// Cuts a vessel across: of the lines in which the plane meets the surface, the one around the point (or nearest to it)
/// becomes the rim of a cap; everything beyond it goes, with the caps there. Throws InputError when that line does not
/// part the surface in two.
void cut_off(artery::Surface& surface, const Vec3& point, const Vec3& normal, const std::string& name);

}  // namespace insula::case_builder
