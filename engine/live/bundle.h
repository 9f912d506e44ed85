// SPDX-License-Identifier: GPL-3.0-or-later
// The viewer's scene bundle: everything about a scene that does not move, as docs/scene-bundle.md describes it.
#pragma once
#include <cstdint>
#include <filesystem>

#include "core/sim/simulation.h"

namespace insula {

/// Writes scene.json and its binary files into `dir`, which is created. scene.json comes last and whole, so that a
/// reader who sees it can read everything. Throws InputError when it cannot be written. With `inventory`,
/// inventory.json is beside it: what is in the scene by name, for a scene that is to be looked at.
void write_bundle(const Simulation& simulation, const std::filesystem::path& dir, std::int64_t session,
                  bool with_inventory = false);

}  // namespace insula
