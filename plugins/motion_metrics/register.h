// SPDX-License-Identifier: GPL-3.0-or-later
// Elements of this plugin that are in files of their own.
#pragma once

namespace insula {

class Registry;
void register_hand_metrics(Registry& registry);
void register_bimanual_metrics(Registry& registry);

}  // namespace insula
