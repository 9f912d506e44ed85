// SPDX-License-Identifier: GPL-3.0-or-later
// Stage 2: the mended surface becomes a wall for simulation: even triangles, centrelines, regions, neck and sac. Still
// in its own frame.
#pragma once
#include "tools/artery/vessel.h"
#include "tools/case_builder/case_folder.h"
#include "tools/case_builder/progress.h"

namespace insula::case_builder {

/// A vessel cut off `keep` mm along its centrelines from the neck (0: not at all), made of about `vertices` vertices.
/// Throws InputError.
artery::Vessel make_wall(const artery::Surface& surface, const Options& options, std::vector<Note>& notes,
                         Progress& progress);

/// The vessel with the necks that are proposed for it, as make_wall() begins. Throws InputError.
artery::Vessel with_proposals(const artery::Surface& surface, const Options& options);
/// How sure the neck is, and every proposal, in the frame of the author's files.
Json neck_json(const artery::Vessel& vessel, bool mirrored);

/// The stage: reads intake/, writes wall/.
void run_wall(const CaseFolder& folder, const Options& options, Progress& progress);

/// A vessel as a stage has written it (mm).
artery::Vessel read_wall(const fs::path& folder);

}  // namespace insula::case_builder
