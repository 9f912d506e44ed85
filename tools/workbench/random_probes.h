// SPDX-License-Identifier: GPL-3.0-or-later
// Short hand motions at random reachable places of a scene's soft bodies, for measuring the servo's force where nobody
// has chosen the place.
#pragma once
#include <cstdint>
#include <string>
#include <vector>

#include "core/sim/motion.h"
#include "core/sim/simulation.h"

namespace insula {

struct Probe {
  std::string name;  ///< "tap frontal 3"
  Motion motion;     ///< begins at the home of each tool
};

/// Taps, drags, presses and squeezes in turn, each with one of three speeds, on lobes and on walls (surfaces with a
/// thickness) in turn. Places are drawn by area over all surfaces of soft bodies. A place counts if a tool reaches it
/// from its home with the orientation of its home: to a point above it, down along the shaft, and then against the
/// normal. Nothing may be touched on the way. The same scene and seed give the same motions.
/// The simulation must be at its start; it is stepped once and reset. Throws InputError if it has no such place.
std::vector<Probe> random_probes(Simulation& simulation, int count, std::uint64_t seed);

}  // namespace insula
