// SPDX-License-Identifier: GPL-3.0-or-later
#include "engine/command_line/studio_command.h"

#include <memory>

#include "engine/command_line/common_options.h"
#include "engine/command_line/page_command.h"
#include "engine/command_line/play_room.h"
#include "training/store/data_folder.h"

namespace insula {
namespace {

struct StudioCommand {
  RoomOptions room;
  std::filesystem::path data;
  ServedPage page{.name = "the studio", .file = "studio.html", .arguments = {}};
};

}  // namespace

void add_studio_command(CommandLine& line) {
  auto o = std::make_shared<StudioCommand>();
  auto* command = line.app.add_subcommand(
      "studio", "a page that makes cases from vessels' surfaces, until Ctrl-C (see docs/studio.md)");
  add_page_options(*command, o->page);
  add_data(*command, o->data);
  command->callback([&line, o] {
    line.chosen = [o](const CommandContext& context) {
      o->room.discovery = false;
      o->page.arguments = room_arguments(o->room, {}, o->data);
      o->page.arguments.insert(o->page.arguments.end(), {"--studio", training::data_folder(o->data).root.string()});
      return serve_page(context, o->page);
    };
  });
}

}  // namespace insula
