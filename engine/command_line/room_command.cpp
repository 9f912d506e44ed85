// SPDX-License-Identifier: GPL-3.0-or-later
#include "engine/command_line/room_command.h"

#include <memory>

#include "engine/command_line/common_options.h"
#include "engine/command_line/page_command.h"
#include "engine/command_line/play_room.h"

namespace insula {
namespace {

struct RoomCommand {
  RoomOptions room;
  std::filesystem::path data;
  ServedPage page{.name = "the room", .file = "room.html", .arguments = {}};
};

}  // namespace

void add_room_command(CommandLine& line) {
  auto o = std::make_shared<RoomCommand>();
  auto* command = line.app.add_subcommand("room", "the overview of all stations of a room, until Ctrl-C");
  command->add_option("--stations", o->room.stations, "file of the room's stations: NAME URL [SHA-256]");
  command->add_option("--room-key", o->room.room_key,
                      "file with the key of the room, readable by its owner alone (default: one made on the page)");
  command->add_flag("!--no-mdns", o->room.discovery, "do not look for stations in the network");
  add_page_options(*command, o->page);
  add_data(*command, o->data);
  command->callback([&line, o] {
    line.chosen = [o](const CommandContext& context) {
      o->page.arguments = room_arguments(o->room, {}, o->data);
      return serve_page(context, o->page);
    };
  });
}

}  // namespace insula
