// SPDX-License-Identifier: GPL-3.0-or-later
// The scripted hands of exercise 4: suction, a temporary clip on the parent, the neck's clip, the temporary clip away.
#pragma once
#include "tools/case_builder/clip_plan.h"
#include "tools/case_builder/progress.h"
#include "tools/case_builder/scene_text.h"

namespace insula::case_builder {

/// Writes 4_rupture_steady.csv. Behind the temporary clip the vessel is slack, so where the blades close best is not
/// where they do on a full one. With `rehearse`, several heights above the neck are played and the best one is kept;
/// a note says what is wrong even then. A plan that leaves a remnant is not rehearsed.
void script_rupture(const CaseFolder& folder, const artery::Vessel& vessel, const ClipPlan& plan,
                    const ApplierPose& temporary, const SceneFacts& facts, bool rehearse, std::vector<Note>& notes,
                    Progress& progress);

}  // namespace insula::case_builder
