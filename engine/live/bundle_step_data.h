// SPDX-License-Identifier: GPL-3.0-or-later
// What a bundle says of the channels, drawables and materials that frames refer to by number or name.
#pragma once
#include <nlohmann/json.hpp>

#include "core/sim/simulation.h"
#include "engine/live/bundle_writer.h"

namespace insula {

nlohmann::ordered_json channels_json(const ChannelTable& channels);
/// Writes the meshes of patches and links; throws InputError when it cannot.
nlohmann::ordered_json drawables_json(const BundleWriter& writer, const Simulation& simulation);
nlohmann::ordered_json materials_json(const std::vector<Material>& materials);

}  // namespace insula
