// SPDX-License-Identifier: GPL-3.0-or-later
// The devices that a scene names.
#pragma once
#include <string>

#include "core/base/diagnostic.h"
#include "core/scene/scene.h"

namespace insula {

/// Adds an error for each unknown device of <devices>.
void check_scene_devices(const Scene& scene, Diagnostics& diagnostics);
/// Device of a hand (0 left, 1 right), in the form of --left and --right; empty if the scene has none.
std::string scene_device(const Scene& scene, int hand);
/// Reason why these devices cannot work on this machine (an unknown device, a library that is not installed); empty if
/// they can, or may later.
std::string device_obstacle(const std::string& wishes);

}  // namespace insula
