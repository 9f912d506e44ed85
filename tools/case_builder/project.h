// SPDX-License-Identifier: GPL-3.0-or-later
// Where the project's own scenes and meshes are, which a case is built on.
#pragma once
#include <filesystem>

namespace insula::case_builder {

/// The nearest folder upwards of `near` that holds scenes/parts and meshes/lobes (a case that stands alone holds other
/// parts too), else that of the program, else the one it was built from. Throws InputError when there is none.
std::filesystem::path find_project(const std::filesystem::path& near);

}  // namespace insula::case_builder
