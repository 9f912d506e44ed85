// SPDX-License-Identifier: GPL-3.0-or-later
// Appearance by name. A plugin adds materials with Registry::add_material, a scene with <material>.
#pragma once
#include <array>
#include <string>

namespace insula {

struct Material {
  std::string name;
  std::string style = "solid";                      ///< how the page draws it: solid, tissue, wall, fibre, sheet, fluid, glass
  std::array<double, 4> rgba{0.75, 0.75, 0.78, 1};  ///< sRGB colour and opacity, 0..1
  double roughness = 0.5;                           ///< 0..1
  double metalness = 0;                             ///< 0..1
  double translucency = 0;                          ///< 0..1
};

}  // namespace insula
