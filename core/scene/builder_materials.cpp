// SPDX-License-Identifier: GPL-3.0-or-later
// The materials of a scene, and the check of every reference to one.
#include <algorithm>

#include "core/scene/builder.h"
#include "core/scene/material_element.h"

namespace insula {

void SceneBuilder::join_materials() {
  std::vector<Material>& all = scene_->materials_;
  all = registry_.materials();
  for (Component* c : scene_->in_order_) {
    const auto* element = dynamic_cast<const MaterialElement*>(c);
    if (!element) continue;
    if (element->id.find('#') != std::string::npos)
      report(*c, c->pos, "a <material> needs an id, by which others refer to it");
    const auto known = std::find_if(all.begin(), all.end(), [&](const Material& m) { return m.name == element->id; });
    if (known != all.end()) *known = element->material();  // replaced by the scene's own material
    else all.push_back(element->material());
  }
  std::vector<std::string> names;
  for (const Material& m : all) names.push_back(m.name);
  const auto wrong = [&](const std::string& name) -> std::string {
    if (std::find(names.begin(), names.end(), name) != names.end()) return {};
    const std::string near = nearest_name(name, names);
    return in_quotes(name) + " is no material" +
           (near.empty() ? " (there are: " + joined(names) + ")" : did_you_mean(near));
  };
  for (Component* c : scene_->in_order_) {
    for (const ParamBase* p : c->params())
      if (const auto* material = dynamic_cast<const Param<MaterialName>*>(p); material && !(*material)().empty())
        if (const std::string why = wrong((*material)()); !why.empty())
          report(*c, p->given() ? p->pos() : c->pos, p->name() + ": " + why);
    for (const DrawableBase* d : c->drawables())
      if (const std::string why = wrong(d->material()); !why.empty() && !failed_.contains(c))
        report(*c, c->pos, "its drawable \"" + std::string(d->spec().name) + "\": " + why);
  }
}

}  // namespace insula
