// SPDX-License-Identifier: GPL-3.0-or-later
// `<material id="silk" style="fibre" colour="0.9 0.9 0.8"/>`: a material that surfaces and drawables of this scene may
// name.
#pragma once
#include "core/registry/component.h"
#include "core/registry/material.h"

namespace insula {

class MaterialElement final : public Component {
 public:
  static constexpr std::string_view kind_name = "material";
  Param<Choice> style{this,
                      {.name = "style",
                       .fallback = "solid",
                       .choices = {"solid", "tissue", "wall", "fibre", "fluid", "glass", "sheet", "aim", "place"},
                       .doc = "way of drawing"}};
  Param<Vec<Scalar>> colour{
      this, {.name = "colour", .fallback = "0.75 0.75 0.78", .min = "0", .max = "1", .doc = "red, green and blue"}};
  Param<Scalar> opacity{this,
                        {.name = "opacity", .fallback = "1", .min = "0", .max = "1", .doc = "0: invisible, 1: opaque"}};
  Param<Scalar> roughness{
      this, {.name = "roughness", .fallback = "0.5", .min = "0", .max = "1", .doc = "0: a mirror, 1: dull"}};
  Param<Scalar> metalness{this, {.name = "metalness", .fallback = "0", .min = "0", .max = "1", .doc = "1: a metal"}};
  Param<Scalar> translucency{this,
                             {.name = "translucency",
                              .fallback = "0",
                              .min = "0",
                              .max = "1",
                              .doc = "share of the light that passes through"}};

  Material material() const {
    return {id,          style(),     {colour().x(), colour().y(), colour().z(), opacity()},
            roughness(), metalness(), translucency()};
  }
};

}  // namespace insula
