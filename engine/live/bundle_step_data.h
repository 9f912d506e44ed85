// SPDX-License-Identifier: GPL-3.0-or-later
// The part of a bundle about the channels, drawables and materials to which frames refer by number or name.
#pragma once
#include <nlohmann/json.hpp>

#include "core/sim/simulation.h"
#include "engine/live/bundle_writer.h"

namespace insula {

nlohmann::ordered_json channels_json(const ChannelTable& channels);
/// Also writes the meshes of patches and links. Throws InputError if it cannot.
nlohmann::ordered_json drawables_json(const BundleWriter& writer, const Simulation& simulation);
nlohmann::ordered_json materials_json(const std::vector<Material>& materials);

}  // namespace insula
