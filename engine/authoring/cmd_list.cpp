// SPDX-License-Identifier: GPL-3.0-or-later
// insula list
#include <fmt/format.h>

#include <algorithm>
#include <optional>
#include <ostream>

#include "engine/authoring/declarations_json.h"
#include "engine/command_line/commands.h"
#include "engine/live/project_folder.h"
#include "engine/sharing/case_list.h"

namespace insula {
namespace {

int print_json(const CommandContext& context, const nlohmann::ordered_json& json) {
  context.out << json.dump(1, ' ', false, nlohmann::ordered_json::error_handler_t::replace) << '\n';
  return 0;
}

nlohmann::ordered_json scenes_json(const std::filesystem::path& data) {
  std::vector<CatalogueEntry> exercises = catalogue(project_folder());
  for (CatalogueEntry& added : added_exercises(data)) exercises.push_back(std::move(added));
  return catalogue_json(exercises);
}

}  // namespace

int cmd_list(const CommandContext& context, const ListOptions& options) {
  if (options.scenes) return print_json(context, scenes_json(options.data));
  if (options.json) return print_json(context, declarations_json(context.registry));
  std::size_t width = 0;
  for (const auto* info : context.registry.all()) width = std::max(width, info->element.size());
  std::optional<Kind> kind;
  for (const auto* info : context.registry.all()) {
    if (kind != info->kind) {
      if (kind) context.out << '\n';
      kind = info->kind;
      context.out << kind_name(info->kind) << '\n';
    }
    const std::string from = info->plugin == "core" ? "" : " [" + info->plugin + "]";
    context.out << fmt::format("  {:<{}}  {}{}\n", info->element, width, info->doc, from);
  }
  context.out << "\n`insula describe NAME` shows the parameters of one.\n";
  return 0;
}

}  // namespace insula
