// SPDX-License-Identifier: GPL-3.0-or-later
// Look-up of components of a scene.
#include "core/scene/scene.h"

#include "core/registry/registry.h"

namespace insula {

Component* Scene::find(std::string_view wanted) const {
  const auto it = by_id_.find(wanted);
  return it == by_id_.end() ? nullptr : it->second;
}

void register_scene(Registry& registry) {
  registry.add<Scene>("scene", Kind::scene,
                      "the root of a scene file: bodies, what joins them, instruments, the exercise");
}

}  // namespace insula
