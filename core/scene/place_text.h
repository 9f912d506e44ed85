// SPDX-License-Identifier: GPL-3.0-or-later
// Where an element may stand, in words.
#pragma once
#include <string>
#include <vector>

#include "core/base/text.h"
#include "core/registry/registry.h"

namespace insula {

/// One text for each kind of parent: "directly in <scene>", or "in a body" followed by what `list_elements` makes of
/// the elements of that kind. Nothing for the root of a scene.
template <class ListElements>
std::vector<std::string> place_texts(const Registry& registry, const ComponentInfo& info,
                                     ListElements&& list_elements) {
  std::vector<std::string> places;
  for (const Kind kind : info.parents) {
    if (kind == Kind::scene) {
      places.push_back("directly in <scene>");
      continue;
    }
    std::vector<std::string> names;
    for (const auto* other : registry.all())
      if (other->kind == kind) names.push_back("<" + other->element + ">");
    places.push_back("in " + with_article(kind_name(kind)) + (names.empty() ? std::string() : list_elements(names)));
  }
  return places;
}

}  // namespace insula
