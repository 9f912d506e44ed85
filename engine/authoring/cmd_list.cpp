// SPDX-License-Identifier: GPL-3.0-or-later
// insula list
#include <fmt/format.h>

#include <algorithm>
#include <optional>
#include <ostream>

#include "engine/command_line/commands.h"

namespace insula {

int cmd_list(const CommandContext& context) {
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
