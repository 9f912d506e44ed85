// SPDX-License-Identifier: GPL-3.0-or-later
// A clip that an author lays over the neck of a built case: where it lies, and what it leaves. The case stays as it is.
#pragma once
#include <filesystem>

#include "tools/case_builder/case_folder.h"
#include "tools/case_builder/progress.h"

namespace insula::case_builder {

/// The text of a scene part with another clip in place of the first of its tray. Unchanged if the clip lies there.
std::string with_clip(std::string part, const std::string& clip);

/// Plays the clipping of the case with the clip and the blades' place of the options. What they do not say is chosen as
/// for a new case. Throws InputError. Gives:
/// - clip, lift_mm, slide_mm, turn_deg: what was tried
/// - goal, grade, remnant_pct, flows_pct, faults, tip_past_neck_mm, told, notes: what came of it
/// - blades: the ends of each blade's middle line; grip, shaft: the applier; in the author's frame, mm
Json try_clip(const CaseFolder& folder, const fs::path& project, const Options& options, Progress& progress);

}  // namespace insula::case_builder
