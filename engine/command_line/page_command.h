// SPDX-License-Identifier: GPL-3.0-or-later
// Commands that serve one page by a gateway alone, without a session, until Ctrl-C.
#pragma once
#include <string>
#include <vector>

#include "engine/command_line/run_command_line.h"

namespace insula {

struct ServedPage {
  std::string name;                    ///< in what is printed
  std::string file;                    ///< of the page, such as room.html
  std::vector<std::string> arguments;  ///< of the gateway
  int port = 8080;
  bool no_browser = false;
};

void add_page_options(CLI::App& command, ServedPage& page);

/// Runs the gateway, with a bus of its own, so that it neither hears nor disturbs a session.
int serve_page(const CommandContext& context, const ServedPage& page);

}  // namespace insula
