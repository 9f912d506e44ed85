// SPDX-License-Identifier: GPL-3.0-or-later
// Two bricks of tissue that face each other: a scene of any size for measurements, made in memory and a temporary
// folder.
#pragma once
#include <memory>

#include "core/sim/simulation.h"

namespace insula {

struct Bricks {
  int cells = 8;        ///< cubes along each edge of the lower brick, (cells + 1)^3 nodes
  int upper_cells = 8;  ///< of the upper one
  double fibres = 0;    ///< between them, 1/cm2 of 9 cm2; taut
  int contacts = 0;     ///< most, with friction, three rows each; the bricks are then pressed together
};

/// Throws std::runtime_error when it cannot be made.
std::unique_ptr<Simulation> brick_scene(const Bricks& bricks, const Registry& registry, int threads);

}  // namespace insula
