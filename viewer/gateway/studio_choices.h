// SPDX-License-Identifier: GPL-3.0-or-later
// What an author chooses for a case on the page of the case builder, and the same as words of its command line.
#pragma once
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

namespace insula::gateway {

/// All of them, as they are for a new case:
/// - of a scan: threshold: null | number, label: null | number, seed: null | [3], around_mm: null | number,
///   paint: [{erase, radius_mm, points: [[3]]}].
/// - of the surface: unit, mirror, any_size, cuts: [[6]], rebuild_mm: null | number.
/// - of the vessel: neck: null | {plane: [6]} | {points: [6]}, inlet: null | [3], keep_mm, vertices,
///   walls: ["neck.young=7 MPa"], wall_patches: [{points: [[3]], radius_mm, thickness, young}], the last two texts with
///   their unit, "" as the region's.
/// - of the case: pose: null | [6] (a shift in mm, a rotation vector in degrees), spin_deg: null | number, rehearse,
/// plays, site, difficulty, rules: ["3.clip.max_grade=1"],
///   clip: "" | name, lift_mm, slide_mm, turn_deg: null | number.
nlohmann::json first_choices();

/// Choices with some of them changed. Throws InputError, which says for the author what is wrong.
nlohmann::json changed_choices(nlohmann::json choices, const nlohmann::json& changes);

/// Of the project's folder, with the strokes for the case builder.
inline constexpr const char* paint_file = "paint.json";

/// Options of `insula case` that say the same: those of its stage intake, and all.
std::vector<std::string> intake_words(const nlohmann::json& choices);
std::vector<std::string> case_words(const nlohmann::json& choices);
/// A pose as the option --pose has it.
std::string pose_words(const nlohmann::json& pose);
/// Those of a clip that is tried over the neck.
std::vector<std::string> clip_words(const nlohmann::json& choices);

}  // namespace insula::gateway
