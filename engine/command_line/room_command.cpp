// SPDX-License-Identifier: GPL-3.0-or-later
#include "engine/command_line/room_command.h"

#include <signal.h>

#include <cstdlib>
#include <memory>
#include <ostream>

#include "engine/command_line/common_options.h"
#include "engine/command_line/play_room.h"
#include "engine/live/open_browser.h"
#include "engine/live/project_folder.h"
#include "engine/live/supervisor.h"

namespace insula {
namespace {

namespace fs = std::filesystem;

struct RoomCommand {
  RoomOptions room;
  int port = 8080;
  fs::path data;
  bool no_browser = false;
};

/// A gateway with a bus of its own, so that it neither hears nor disturbs a session.
int cmd_room(const CommandContext& context, const RoomCommand& o) {
  ::setenv("LCM_DEFAULT_URL", "memq://", 1);
  signal(SIGPIPE, SIG_IGN);
  const Supervisor::Print print = [&out = context.out](std::string_view line) { out << line << std::endl; };
  ChildSpec gateway;
  gateway.name = "gateway";
  gateway.ends_session = true;
  gateway.command = {(own_program().parent_path() / "gateway").string(), "--port", std::to_string(o.port)};
  const std::vector<std::string> more = room_arguments(o.room, {}, o.data);
  gateway.command.insert(gateway.command.end(), more.begin(), more.end());
  gateway.on_line = [&, first = true](ChildSpec&, std::string_view line) mutable {
    constexpr std::string_view serving = "serving ";
    if (!line.starts_with(serving)) return !line.starts_with("the room is at ");
    const std::string url = std::string(line.substr(serving.size())) + "room.html";
    print("insula: the room is at " + url);
    if (std::exchange(first, false) && !o.no_browser) open_browser(url);
    return false;
  };
  Supervisor supervisor({}, print);
  supervisor.add(gateway);
  return supervisor.run();
}

}  // namespace

void add_room_command(CommandLine& line) {
  auto o = std::make_shared<RoomCommand>();
  auto* command = line.app.add_subcommand("room", "the overview of all stations of a room, until Ctrl-C");
  command->add_option("--stations", o->room.stations, "file of the room's stations: NAME URL [SHA-256]");
  command->add_option("--room-key", o->room.room_key,
                      "file with the key of the room, readable by its owner alone (default: one made on the page)");
  command->add_flag("!--no-mdns", o->room.discovery, "do not look for stations in the network");
  command->add_option("--port", o->port, "of the page; following ones are tried if it is busy")->capture_default_str();
  command->add_flag("--no-browser", o->no_browser, "open no browser");
  add_data(*command, o->data);
  command->callback([&line, o] { line.chosen = [o](const CommandContext& context) { return cmd_room(context, *o); }; });
}

}  // namespace insula
