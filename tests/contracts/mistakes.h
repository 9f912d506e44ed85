// SPDX-License-Identifier: GPL-3.0-or-later
// Plugins with exactly one mistake each, by name.
#pragma once
#include "core/registry/registry.h"

namespace insula::mistakes {

void add_threads(Registry& registry);  ///< constraints that pull: "thread_..."
void add_balls(Registry& registry);    ///< constraints that push, in the form of contacts: "ball_..."
void add_springs(Registry& registry);  ///< force models: "springs_..."
void add_others(Registry& registry);   ///< supports "hold_...", exercise rules "rule_...", instruments "probe_..."

}  // namespace insula::mistakes
