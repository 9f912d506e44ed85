// SPDX-License-Identifier: GPL-3.0-or-later
// The JSON of Haply's Inverse Service (versions 3.1 to 3.5, simulation channel).
#pragma once
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "core/base/math.h"

namespace insula {

/// An arm in one message. Fields that the message does not contain are empty.
struct HaplyArm {
  std::string id;
  std::string handedness;  ///< "left", "right"; only in the first message
  std::string type;        ///< "inverse3", "inverse3x", "minverse"; only in the first message
  bool ready = true;
  std::optional<Vec3> p_m, v_m_s;
};

/// A Verse Grip, wired or wireless: the orientation of the tool and its buttons.
struct HaplyGrip {
  std::string id;
  std::optional<Quat> q;
  bool button1 = false, button2 = false;
};

struct HaplyState {
  bool named_vector = false;  ///< the service uses the name "vector" for a force's numbers
  std::vector<HaplyArm> arms;
  std::vector<HaplyGrip> grips;
};

/// False, with the reason, for any other message; `state` is then not valid. Never throws. A vector stays empty if a
/// number of it is missing, not a number or not finite.
bool parse_haply(std::string_view text, HaplyState& state, std::string& why);

/// The command of one tick. The service answers each with one state. Forces are in the service's axes, N. `introduce`:
/// adds the session's name for Haply's own programs.
std::string haply_force(const std::string& arm, const Vec3& force_N, bool named_vector, bool introduce);

}  // namespace insula
