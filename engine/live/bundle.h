// SPDX-License-Identifier: GPL-3.0-or-later
// The viewer's scene bundle: the static data of a scene (docs/scene-bundle.md).
#pragma once
#include <cstdint>
#include <filesystem>

#include "core/sim/simulation.h"

namespace insula {

/// Writes scene.json and its binary files into `dir`, which is created. scene.json is written last and at once, so a
/// reader that finds it can read everything. Throws InputError if it cannot be written. `with_inventory`: also writes
/// inventory.json, for `insula view`.
void write_bundle(const Simulation& simulation, const std::filesystem::path& dir, std::int64_t session,
                  bool with_inventory = false);

}  // namespace insula
