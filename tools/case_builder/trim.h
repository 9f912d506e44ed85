// SPDX-License-Identifier: GPL-3.0-or-later
// Cuts a vessel's ends off where they lead far away from its aneurysm.
#pragma once
#include "tools/artery/vessel.h"
#include "tools/case_builder/case_folder.h"

namespace insula::case_builder {

/// The surface that is left when every centreline is cut `keep` mm (along the lines) from the point of them nearest to
/// `neck`. Each cut is noted; one that cannot be made straight is tried a little farther out, then left and noted as a
/// problem.
artery::Surface trimmed(const artery::Surface& surface, const std::vector<artery::NamedCurve>& lines, const Vec3& neck,
                        double keep, std::vector<Note>& notes);

}  // namespace insula::case_builder
