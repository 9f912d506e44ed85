// SPDX-License-Identifier: GPL-3.0-or-later
// The reference page of curriculum files.
#pragma once
#include <string>

namespace insula {

/// A section for each element, in Markdown, from the declarations.
std::string curriculum_reference();

}  // namespace insula
