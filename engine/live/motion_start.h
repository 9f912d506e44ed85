// SPDX-License-Identifier: GPL-3.0-or-later
// Whether a motion may start where it does. A tool begins at its home, and in the first step its coupling takes it to
// the hand's first pose at once. If contact stops it on the way, the coupling presses it there. The spring is then
// stretched by the rest of the way.
#pragma once
#include "core/sim/motion.h"
#include "core/sim/simulation.h"

namespace insula {

/// Largest distance between the tip of a tool at home and the first position of its hand, m.
inline constexpr double farthest_start_m = 0.1;
/// A motion may begin in contact. The first pose may lie this far behind the first thing that the tool meets, m.
inline constexpr double deepest_start_m = 0.01;

/// Throws InputError if a hand's first position is farther away from the home of its tool, or if the way there is not
/// free. The way is a straight line, on which the tool turns evenly. It is not free if the tool passes through a
/// surface or a rigid body that it may touch, or goes deeper into one than deepest_start_m. The start is not checked if
/// no point of the tool moves by more than 1 mm, since contact then sees everything. Nor is it if the hand takes up a
/// tool at 0 s: an exchange puts the tool where the hand is. Rigid bodies that the tool holds or touches at home are
/// left out.
void check_start(const Simulation& simulation, const Motion& motion);

}  // namespace insula
