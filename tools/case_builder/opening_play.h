// SPDX-License-Identifier: GPL-3.0-or-later
// Whether the scripted hands of exercise 1, made for the shipped lobes, open the fissure of an author's own brain too.
#pragma once
#include "tools/case_builder/progress.h"
#include "tools/case_builder/scene_text.h"

namespace insula::case_builder {

/// Plays exercise 1 of the case. Where it does not finish, or earns a fault, the exercise is left without scripted
/// hands and a note says so. Without a rehearsal it has none from the start.
void try_opening(SceneFacts& facts, const CaseFolder& folder, bool rehearse, std::vector<Note>& notes,
                 Progress& progress);

}  // namespace insula::case_builder
