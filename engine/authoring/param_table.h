// SPDX-License-Identifier: GPL-3.0-or-later
// Parameters in the reference pages, in Markdown.
#pragma once
#include <string>
#include <string_view>

#include "core/params/param.h"

namespace insula {

/// A text for a cell of a table; "-" if it is empty.
std::string cell(std::string_view text);
/// A table of the id and of all parameters, with types, defaults and ranges.
std::string param_table(const ParamSet& params);

}  // namespace insula
