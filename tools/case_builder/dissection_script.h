// SPDX-License-Identifier: GPL-3.0-or-later
// The strands of a case's second exercise and the scripted hands that divide them, both found in the running scene.
#pragma once
#include "tools/case_builder/scene_text.h"

namespace insula::case_builder {

/// Writes the exercises of the case, spins the strands of the second one (facts.strand_sets and what goes with them are set: kinds for
/// which there is no place are left out, strands are thinned out and moved towards the surgeon until a blade gets at them), and, when
/// asked to, rehearses the dissection and writes its motion. Throws InputError when the exercise does not load.
void spin_strands(SceneFacts& facts, const CaseFolder& folder, bool rehearse, std::vector<Note>& notes, Progress& progress);

}  // namespace insula::case_builder
