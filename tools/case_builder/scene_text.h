// SPDX-License-Identifier: GPL-3.0-or-later
// The text of a case's scene files.
#pragma once
#include "tools/case_builder/clip_plan.h"
#include "tools/case_builder/region_walls.h"
#include "tools/case_builder/retractors.h"
#include "tools/case_builder/rules.h"
#include "tools/case_builder/scenes.h"
#include "tools/case_builder/wall_patches.h"

namespace insula::case_builder {

/// What the texts are made of.
struct SceneFacts {
  std::string name;
  Approach approach;
  Assets assets;
  std::vector<WallOf> walls;
  std::vector<PatchOf> patches;    ///< where the vessel lies now
  std::string tethered;            ///< regions that the surroundings hold
  std::string branches;            ///< centrelines that lead to outlets: their flow is to stay
  Vec3 neck, dome;                 ///< mm
  double dome_reach = 0;           ///< from the neck to the farthest of the sac, mm
  std::vector<std::string> clips;  ///< on the tray; the first is the one for the neck
  std::string temporary;
  bool bleb = false;
  std::vector<std::string> strand_sets;
  double strand_share = 1;  ///< of the usual density of strands
  double strand_shift = 0;  ///< mm that their balls lie nearer to the surgeon
  std::vector<RuleChange> rules = {};
  fs::path folder = {};                                     ///< of the case
  std::string site = {};                                    ///< Exercise::site
  int difficulty = 0;                                       ///< Exercise::difficulty
  std::optional<std::vector<RetractorAt>> retractors = {};  ///< in place of those of the approach
  bool opened = true;                                       ///< exercise 1 has scripted hands
  bool rehearsed = false;                                   ///< exercise 2 has scripted hands
};

std::string artery_part(const SceneFacts& facts);
std::string field_part(const SceneFacts& facts);
/// The fissure held open by the author's own retractors. Only with SceneFacts::retractors.
std::string retractors_part(const SceneFacts& facts);
/// Kinds of strands about the aneurysm: to each lobe, and between branches and sac.
std::vector<std::string> all_strand_sets(const Approach& approach);
/// Strands of one kind about the aneurysm: to a lobe, or "branches".
std::string strands(const SceneFacts& facts, const std::string& kind);
std::string exercise(const SceneFacts& facts, int number);
/// Without the author's changes of its rules.
std::string proposed_exercise(const SceneFacts& facts, int number);

}  // namespace insula::case_builder
