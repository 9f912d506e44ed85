// SPDX-License-Identifier: GPL-3.0-or-later
// A URDF file parsed by urdfdom. The messages that urdfdom only prints become an InputError.
#pragma once
#include <urdf_model/model.h>
#include <urdf_world/types.h>

#include <filesystem>

namespace insula {

/// Throws InputError: unreadable, not well-formed (with line and column), anything that urdfdom reports as an error.
urdf::ModelInterfaceSharedPtr parse_urdf(const std::filesystem::path& file);

}  // namespace insula
