// SPDX-License-Identifier: GPL-3.0-or-later
// Ends of a closed vessel that are neither open nor flat: rounded ones, and flat ones whose noise hides that they are.
#pragma once
#include "tools/artery/surface.h"
#include "tools/case_builder/case_folder.h"
#include "tools/case_builder/openings.h"

namespace insula::case_builder {

/// Cuts such ends straight where the tube has its full calibre, and notes each cut. A sac is an end too; it is told
/// from a vessel by its calibre, which does not stay the same for long. A torn border is an end that is known, so a
/// shorter tube is enough there. The surface is closed and in one piece.
///
/// Ends are the leaves of the Reeb graph of the geodesic distance from one end. The line of each is that of the middles
/// of the level lines of the distance from its tip, as in Verroust, Lazarus, "Extracting skeletal curves from 3D
/// scattered data", The Visual Computer 16 (2000).
void cut_blind_ends(artery::Surface& surface, const std::vector<TornBorder>& torn, std::vector<Note>& notes);

}  // namespace insula::case_builder
