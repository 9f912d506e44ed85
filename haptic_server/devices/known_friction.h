// SPDX-License-Identifier: GPL-3.0-or-later
// Backdrive friction of arms by their makers' data sheets: what a force must exceed to be felt as it is.
#pragma once
#include <array>

namespace insula {

struct KnownFriction {
  const char* devices;
  double friction_N;
};
inline constexpr KnownFriction touch_friction{"Phantom Omni, Touch", 0.26};
inline constexpr KnownFriction touch_x_friction{"Touch X, Premium", 0.06};
inline constexpr std::array known_frictions{touch_friction, touch_x_friction};

}  // namespace insula
