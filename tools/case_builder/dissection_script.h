// SPDX-License-Identifier: GPL-3.0-or-later
// The strands of a case's second exercise and the scripted hands that divide them, both found in the running scene.
#pragma once
#include "tools/case_builder/scene_text.h"

namespace insula::case_builder {

/// Writes the exercises of the case and creates the strands of the second one. It sets facts.strand_sets and what
/// belongs to them. Kinds without a suitable position are left out, and strands are thinned out and moved towards the
/// surgeon until a blade reaches them. With `rehearse`, the dissection is rehearsed and its motion is written. Throws
/// InputError when the exercise does not load.
void spin_strands(SceneFacts& facts, const CaseFolder& folder, bool rehearse, std::vector<Note>& notes,
                  Progress& progress);

}  // namespace insula::case_builder
