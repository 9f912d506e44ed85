// SPDX-License-Identifier: GPL-3.0-or-later
// Backdrive friction of arms from their makers' data sheets. A force must exceed it to be perceptible.
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
