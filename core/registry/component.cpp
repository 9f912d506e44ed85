// SPDX-License-Identifier: GPL-3.0-or-later
// Common part of all components.
#include "core/registry/component.h"

#include "core/base/text.h"

namespace insula {

std::string_view kind_name(Kind kind) {
  switch (kind) {
    case Kind::scene: return "scene";
    case Kind::settings: return "settings";
    case Kind::body: return "body";
    case Kind::surface: return "surface";
    case Kind::force_model: return "force model";
    case Kind::support: return "support";
    case Kind::constraint: return "constraint";
    case Kind::instrument: return "instrument";
    case Kind::exercise: return "exercise";
    case Kind::exercise_rule: return "exercise rule";
    case Kind::motion: return "motion";
    case Kind::complications: return "list of complications";
    case Kind::complication: return "complication";
    case Kind::material: return "material";
    case Kind::metric: return "metric";
    case Kind::condition: return "condition";
  }
  return "component";
}

void Component::error(PrepareContext& context, std::string text) const {
  context.diagnostics.error(pos, std::move(text));
}

void Component::error(PrepareContext& context, const ParamBase& param, std::string text) const {
  // Readers report the full path of a file. The author knows the path as written.
  if (const auto* file = dynamic_cast<const Param<File>*>(&param); file && !file->empty()) {
    const std::string path = (*file)().string() + ": ";
    if (text.starts_with(path)) text.replace(0, path.size(), in_quotes(param.text()) + ": ");
  }
  const std::string name = param.name() + ": ";
  if (!text.starts_with(name)) text.insert(0, name);
  context.diagnostics.error(param.given() ? param.pos() : pos, std::move(text));
}

}  // namespace insula
