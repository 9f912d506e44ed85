// SPDX-License-Identifier: GPL-3.0-or-later
// The scripted hands of exercise 3, found by playing it. A surgeon who sees a remnant or a narrowed branch opens the
// blades, and tries again a little deeper, higher or turned; so does this search.
#pragma once
#include <string>
#include <utility>
#include <vector>

#include "tools/case_builder/clip_plan.h"
#include "tools/case_builder/progress.h"

namespace insula::case_builder {

/// What one placement of the clip came to.
struct ClippingOutcome {
  bool goal = false;                                  ///< the exercise's goal was held
  int grade = 5;                                      ///< Sindou
  double remnant = 1;                                 ///< share of the neck above which a remnant is left
  double tip_past_neck = 0;                           ///< mm
  double slit = 0;                                    ///< between the blades, mm
  std::vector<std::pair<std::string, double>> flows;  ///< of each branch over that at rest
  double stenosis = 0;                                ///< of the branch that is narrowed most, share of its lumen
  int faults = 0;                                     ///< forces included
  bool ruptured = false;
  std::string told;  ///< what is wrong, in words; empty: nothing

  double least_flow() const;
  bool shut() const { return remnant < 1; }  ///< no blood passes the neck
  /// The goal without a fault, at grade 0 or 1, with less than a quarter of the neck open.
  bool sound() const { return goal && faults == 0 && grade <= 1 && remnant < 0.25; }
  /// The less, the better; comparable between placements of one case.
  double cost() const;
};

struct RehearsedClip {
  ClipPlan plan;
  ClippingOutcome outcome;
  int plays = 0;
};

/// The hands' motion for a plan, as the text of a file.
std::string clipping_motion(const ClipPlan& plan);

/// Different plans among the best, at most `most` of them: other clips, other turns. Half of them reach over the whole
/// neck, if there are such.
std::vector<ClipPlan> distinct_plans(const std::vector<ClipPlan>& ranked, std::size_t most);

/// Plays the written exercise with the clips of `tried`, whose first motion is the file `motion`. The plans' blades are
/// placed at the neck as it is under pressure, between the lobes. correct: placements near the best plan are tried too.
/// The search ends after `most_plays`.
/// The same case gives the same bits. Throws InputError if the scene does not load.
RehearsedClip rehearse_clipping(const fs::path& scene, const fs::path& motion, const artery::Vessel& at_rest,
                                const std::vector<ClipPlan>& tried, bool correct, int most_plays, Progress& progress);

/// What is wrong with the played plan; a fact if nothing is.
std::vector<Note> notes_of(const RehearsedClip& clipped);
/// {"grade", "remnant_pct", "flows_pct", "faults", "goal"}
Json to_json(const ClippingOutcome& outcome);

}  // namespace insula::case_builder
