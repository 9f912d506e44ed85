// SPDX-License-Identifier: GPL-3.0-or-later
// insula view SCENE --list. Without --list, insula play shows the scene with a stopped engine.
#include <fmt/format.h>

#include <ostream>

#include "engine/authoring/inventory.h"
#include "engine/command_line/play.h"

namespace insula {

int cmd_view_list(const CommandContext& context, const std::filesystem::path& scene) {
  const SimulationResult loaded = load_simulation(scene, context.registry);
  context.err << loaded.diagnostics.format();
  if (!loaded.simulation) return 2;
  std::string group;
  for (const InventoryItem& item : inventory(*loaded.simulation)) {
    if (item.group != group) context.out << fmt::format("{}{}:\n", group.empty() ? "" : "\n", item.group);
    group = item.group;
    context.out << fmt::format("  {:32} <{}>  {}\n", item.name, item.element, item.size);
  }
  return 0;
}

}  // namespace insula
