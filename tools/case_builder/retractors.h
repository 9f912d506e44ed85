// SPDX-License-Identifier: GPL-3.0-or-later
// Brain retractors of an author's own: where each stands, and which lobe it draws aside. Millimetres, frame of the
// approach's meshes. Without them a case has those of the approach's open part.
#pragma once
#include <string>
#include <vector>

#include "core/model/mesh.h"
#include "tools/case_builder/approach.h"

namespace insula::case_builder {

constexpr std::size_t most_retractors = 4;
constexpr double most_pull = 15;  ///< mm
constexpr double most_lean = 80;  ///< degrees, of a shaft off the line of sight

/// As it stands when the exercise begins. It comes from `pull` behind its flat side, and draws the lobe by as much.
struct RetractorAt {
  std::string lobe;
  Vec3 tip = Vec3::Zero();
  Vec3 shaft = Vec3::UnitZ();  ///< unit, to the handle
  Vec3 flat = Vec3::UnitX();   ///< unit, across the shaft: the side that presses
  double pull = 0;
};

/// "frontal, 53.5 15 -0.1 mm, shaft=0.8 0.2 0.5, flat=0 -0.1 1, pull=5 mm": the lobe, the tip, and what is not as that
/// of the approach's retractor of this lobe. Throws InputError.
RetractorChoice read_retractor(const std::string& text);

/// With what is not given taken from `proposed`. Throws InputError, in an author's words, when one has no such lobe,
/// lies outside of the lobes or stands out of reach of a hand.
std::vector<RetractorAt> chosen_retractors(const std::vector<RetractorChoice>& choices,
                                           const std::vector<RetractorAt>& proposed, const Approach& approach);

/// A blade's shape, given with its tip at the origin, its shaft along z and its flat side along x.
TriMesh at_place(const TriMesh& blade, const RetractorAt& retractor);
/// All of them.
TriMesh at_places(const TriMesh& blade, const std::vector<RetractorAt>& retractors);

/// [{lobe, tip_mm, shaft, flat, pull_mm}]
Json to_json(const std::vector<RetractorAt>& retractors);
std::vector<RetractorAt> retractors_from(const Json& json);

}  // namespace insula::case_builder
