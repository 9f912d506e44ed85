// SPDX-License-Identifier: GPL-3.0-or-later
// The ends of a vessel: round borders are closed by flat caps, small holes are filled, planes cut ends where the author
// wants them.
#pragma once
#include "tools/artery/surface.h"
#include "tools/case_builder/case_folder.h"

namespace insula::case_builder {

/// Closes every border of an agreeing, two-sided surface. Round and nearly flat ones become caps; holes much smaller
/// than those are filled. Throws InputError for a hole that is neither. Every repair is noted.
artery::Surface closed_surface(const TriMesh& mesh, std::vector<Note>& notes);

/// Cuts a vessel across: of the lines in which the plane meets the surface, the one around the point (or nearest to it)
/// becomes the rim of a cap; everything beyond it goes, with the caps there. Throws InputError when that line does not
/// part the surface in two.
void cut_off(artery::Surface& surface, const Vec3& point, const Vec3& normal, const std::string& name);

}  // namespace insula::case_builder
