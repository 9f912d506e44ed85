// SPDX-License-Identifier: GPL-3.0-or-later
// assimp's handler of failed assertions. Its declaration here makes the linker keep ours.
#pragma once

namespace Assimp {

/// Throws std::runtime_error, which assimp's importer reports as a failed import.
__attribute__((visibility("default"))) void aiAssertViolation(const char* expression, const char* file, int line);

}  // namespace Assimp
