// SPDX-License-Identifier: GPL-3.0-or-later
// From the attributes of an element to the parameters that its declaration has, with the messages of what is wrong.
// Scenes and curricula are read by it.
#pragma once
#include <functional>
#include <string>
#include <string_view>
#include <vector>

#include "core/base/diagnostic.h"
#include "core/params/param_set.h"
#include "core/scene/suggestions.h"
#include "core/xml/document.h"

namespace insula {

/// Takes an error of a reader, with its place in the file.
using ReportAt = std::function<void(const SourcePos&, std::string)>;

/// Whether a text may be an id: letters, digits and . _ -, at most 128 bytes.
bool is_id(std::string_view text);
/// "a, b, c", with at most twelve names.
std::string first_names(const std::vector<std::string>& names);

/// Gives the attributes of an element to the parameters of `set`. The id is left to the caller. Reports unknown and
/// renamed attributes, values that are not accepted, and required parameters that are missing.
void read_params(const Element& element, ParamSet& set, Suggestions& suggestions, const ReportAt& report);

}  // namespace insula
