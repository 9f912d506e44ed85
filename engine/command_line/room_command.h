// SPDX-License-Identifier: GPL-3.0-or-later
// insula room: the overview of all stations, without a session.
#pragma once
#include "engine/command_line/run_command_line.h"

namespace insula {

void add_room_command(CommandLine& line);

}  // namespace insula
