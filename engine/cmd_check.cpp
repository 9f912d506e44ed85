// SPDX-License-Identifier: GPL-3.0-or-later
// insula check SCENE...
#include <fmt/format.h>

#include <algorithm>
#include <exception>
#include <ostream>

#include "core/scene/loader.h"
#include "core/sim/simulation.h"
#include "engine/commands.h"

namespace insula {
namespace {

/// One scene: loaded, and put together as for a run, since some mistakes show only there. Returns the line to print.
std::string check_one(const std::filesystem::path& file, const Registry& registry, Diagnostics& diagnostics) {
  auto loaded = load_scene(file, registry);
  diagnostics = std::move(loaded.diagnostics);
  if (!loaded.scene) return {};
  const auto& components = loaded.scene->components();
  const auto bodies = std::count_if(components.begin(), components.end(), [](const Component* c) { return c->kind == Kind::body; });
  const std::string line = fmt::format("{}: ok, {} components, {} bodies, content {:016x}\n", file.generic_string(), components.size(), bodies,
                                       loaded.scene->content_hash());
  try {
    const Simulation simulation(std::move(loaded.scene), diagnostics, 1);
  } catch (const std::exception& e) {
    diagnostics.error({file.generic_string(), 0, 0}, e.what());
  }
  diagnostics.sort_by_position();
  return diagnostics.ok() ? line : std::string();
}

}  // namespace

int cmd_check(const CommandContext& context, const std::vector<std::filesystem::path>& files) {
  int status = 0;
  for (const auto& file : files) {
    Diagnostics diagnostics;
    const std::string line = check_one(file, context.registry, diagnostics);
    context.err << diagnostics.format();
    if (line.empty()) status = 2;
    context.out << line;
  }
  return status;
}

}  // namespace insula
