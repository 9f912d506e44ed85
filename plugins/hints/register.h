// SPDX-License-Identifier: GPL-3.0-or-later
// The elements of this plugin that have files of their own.
#pragma once
#include "core/registry/registry.h"

namespace insula {

void register_limit_hints(Registry& registry);
void register_hint_metric(Registry& registry);
void register_hint_approach(Registry& registry);

}  // namespace insula
