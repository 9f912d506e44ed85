// SPDX-License-Identifier: GPL-3.0-or-later
// Rates of one machine, written down: an estimate with them follows from a scene's counts alone, on any machine.
#pragma once
#include "tools/workbench/cost_model.h"

namespace insula {

/// Of a server's core at 3 GHz, seconds.
inline constexpr CostRates server_core{.tetrahedron = 5e-8,
                                       .tetrahedron_force = 2.1e-8,
                                       .factor_flop = 2.5e-11,
                                       .factor_entry = 1e-9,
                                       .solve_entry = 2.8e-10,
                                       .compliance_flop = 2.4e-11,
                                       .compliance_row2 = 7.5e-10,
                                       .vertex = 7.2e-9,
                                       .sweep_row2 = 1.4e-10};

}  // namespace insula
