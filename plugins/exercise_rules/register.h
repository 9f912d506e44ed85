// SPDX-License-Identifier: GPL-3.0-or-later
// The elements of this plugin that have files of their own.
#pragma once
#include "core/registry/registry.h"

namespace insula {

void register_channel_rules(Registry& registry);
void register_event_rules(Registry& registry);
void register_two_hands_rule(Registry& registry);

}  // namespace insula
