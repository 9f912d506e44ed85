// SPDX-License-Identifier: GPL-3.0-or-later
// The tutor's cues in reports and beside the picture: what was said when, and which value came near which limit.
#pragma once
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "core/sim/tutor.h"

namespace insula {

/// {id, text, hand: "left" | "right" | "", watched, value, limit, share, holds}.
nlohmann::ordered_json hint_json(const HintCause& cause);
/// The same with time_s, for each cue.
nlohmann::ordered_json cues_json(const std::vector<Cue>& cues);
/// A table with a line for each cue; empty if there are none. seen: whether they were shown.
std::string cues_html(const std::vector<Cue>& cues, bool seen);

}  // namespace insula
