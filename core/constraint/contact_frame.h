// SPDX-License-Identifier: GPL-3.0-or-later
// Prediction of a contact's frame after the step in which its rows were built.
#pragma once
#include "core/base/math.h"

namespace insula {

/// Frame of a friction contact. All vectors are unit vectors in the scene frame.
struct ContactFrame {
  int row;       ///< first of the contact's three rows: normal, tangent, normal x tangent
  Vec3 normal;   ///< of the rows in the problem of the step
  Vec3 tangent;  ///< of the second row
  Vec3 ahead;    ///< the normal after the requested time, if tool and surface move on as in the step
  Vec3 later;    ///< the normal one step after that
};

}  // namespace insula
