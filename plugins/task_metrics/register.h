// SPDX-License-Identifier: GPL-3.0-or-later
// Elements of this plugin that are in files of their own.
#pragma once

namespace insula {

class Registry;
void register_region_touch_metric(Registry& registry);

}  // namespace insula
