// SPDX-License-Identifier: GPL-3.0-or-later
// insula check SCENE...
#include <fmt/format.h>

#include <algorithm>
#include <ostream>

#include "core/scene/loader.h"
#include "engine/commands.h"

namespace insula {

int cmd_check(const CommandContext& context, const std::vector<std::filesystem::path>& files) {
  int status = 0;
  for (const auto& file : files) {
    const auto result = load_scene(file, context.registry);
    context.err << result.diagnostics.format();
    if (!result.ok()) {
      status = 2;
      continue;
    }
    const auto& components = result.scene->components();
    const auto bodies = std::count_if(components.begin(), components.end(), [](const Component* c) { return c->kind == Kind::body; });
    context.out << fmt::format("{}: ok, {} components, {} bodies, content {:016x}\n", file.generic_string(), components.size(), bodies,
                               result.scene->content_hash());
  }
  return status;
}

}  // namespace insula
