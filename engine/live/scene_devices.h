// SPDX-License-Identifier: GPL-3.0-or-later
// The devices that a scene names.
#pragma once
#include <string>

#include "core/base/diagnostic.h"
#include "core/scene/scene.h"

namespace insula {

/// Adds an error for each device of <devices> that is none.
void check_scene_devices(const Scene& scene, Diagnostics& diagnostics);
/// Of a hand (0 left, 1 right), as for --left and --right; empty where the scene does not say.
std::string scene_device(const Scene& scene, int hand);
/// Why these devices can never work on this machine (a word that is no device, a library that is not installed); empty:
/// they can, or may yet.
std::string device_obstacle(const std::string& wishes);

}  // namespace insula
