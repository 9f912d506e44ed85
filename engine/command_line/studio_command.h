// SPDX-License-Identifier: GPL-3.0-or-later
// insula studio: the page of the case builder.
#pragma once
#include "engine/command_line/run_command_line.h"

namespace insula {

void add_studio_command(CommandLine& line);

}  // namespace insula
