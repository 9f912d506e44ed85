// SPDX-License-Identifier: GPL-3.0-or-later
// The declarations of all elements as JSON, for editors of scenes.
#pragma once
#include <nlohmann/json.hpp>

#include "core/registry/registry.h"

namespace insula {

/// {elements: [{name, kind, doc, plugin, children: [name], parameters: [{name, type, doc, required, default, min, max,
///  choices: [text], units: [{symbol, to_si}], numbers, whole, reference, list}]}]}
///
/// numbers: how many numbers a value has; 0: as many as one likes; missing: it is no number. reference: kind of the
/// component that a value names; list: it may name several. Elements without a kind (part, include, variable) are those
/// that the loader replaces.
nlohmann::ordered_json declarations_json(const Registry& registry);

}  // namespace insula
