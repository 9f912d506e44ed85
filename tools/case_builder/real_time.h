// SPDX-License-Identifier: GPL-3.0-or-later
// A wall as fine as real time allows. What a step takes while a clip closes is estimated from counts, with the rates of
// one machine that are written down. So the same input gives the same wall on every machine.
#pragma once
#include <optional>

#include "tools/case_builder/case_folder.h"
#include "tools/case_builder/progress.h"
#include "tools/workbench/cost_model.h"

namespace insula::case_builder {

/// Whose time is kept.
struct Pace {
  CostRates rates;  ///< of one core
  int cores = 2;
  double of_step = 0.5;  ///< share of a time step that its work may take; the rest is for haptics and the page
};
/// The machine that the library of cases is held to.
Pace usual_pace();

/// Whether a usual step leaves that time, and the worst one takes no longer than a step: all contacts of tools are at
/// their limits, and a kept factor is made anew.
bool keeps_pace(const SceneWork& work, const Pace& pace);

/// The work with so many times the vertices of each wall. Rows are as many as before.
SceneWork with_coarser_walls(SceneWork work, double share);

/// How many vertices in place of `vertices` let the work keep pace. Nothing where it does so already, or where no wall
/// that a clip could close would help.
std::optional<int> coarser_wall(const SceneWork& work, int vertices, const Pace& pace);

/// The work of a placed case's third exercise as it begins, with the rows that hands and a closed clip will add.
SceneWork work_of_clipping(const CaseFolder& folder, const fs::path& project, const Options& options,
                           Progress& progress);

/// Where the work of a placed case's third exercise is too much, wall and place are made again with fewer
/// vertices (Options::coarser), unless those are the author's own. Returns whether that was so.
bool keep_real_time(const CaseFolder& folder, const fs::path& project, Options& options, const Pace& pace,
                    Progress& progress);

}  // namespace insula::case_builder
