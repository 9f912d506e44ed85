// SPDX-License-Identifier: GPL-3.0-or-later
// Clinical units for pages and reports. The program itself uses SI.
#pragma once

namespace insula {

inline constexpr double pascal_per_mmHg = 133.322387415;  // NIST SP 811
inline constexpr double m3_per_mL = 1e-6;
inline constexpr double m3_s_per_mL_min = 1e-6 / 60;

}  // namespace insula
