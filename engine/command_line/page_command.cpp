// SPDX-License-Identifier: GPL-3.0-or-later
#include "engine/command_line/page_command.h"

#include <signal.h>

#include <CLI/CLI.hpp>
#include <ostream>
#include <utility>

#include "engine/live/open_browser.h"
#include "engine/live/project_folder.h"
#include "engine/live/supervisor.h"

namespace insula {

void add_page_options(CLI::App& command, ServedPage& page) {
  command.add_option("--port", page.port, "of the page; following ones are tried if it is busy")->capture_default_str();
  command.add_flag("--no-browser", page.no_browser, "open no browser");
}

int serve_page(const CommandContext& context, const ServedPage& page) {
  signal(SIGPIPE, SIG_IGN);
  const Supervisor::Print print = [&out = context.out](std::string_view line) { out << line << std::endl; };
  ChildSpec gateway;
  gateway.name = "gateway";
  gateway.ends_session = true;
  gateway.command = {(own_program().parent_path() / "gateway").string(), "--bus", "memq://", "--port",
                     std::to_string(page.port)};
  gateway.command.insert(gateway.command.end(), page.arguments.begin(), page.arguments.end());
  gateway.on_line = [&, first = true](ChildSpec&, std::string_view line) mutable {
    constexpr std::string_view serving = "serving ";
    if (!line.starts_with(serving)) return !line.starts_with("the room is at ");
    const std::string url = std::string(line.substr(serving.size())) + page.file;
    print("insula: " + page.name + " is at " + url);
    if (std::exchange(first, false) && !page.no_browser) open_browser(url);
    return false;
  };
  Supervisor supervisor({}, print);
  supervisor.add(gateway);
  return supervisor.run();
}

}  // namespace insula
