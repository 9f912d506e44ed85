// SPDX-License-Identifier: GPL-3.0-or-later
// The command `study`, which the Python package carries out (python/insula/studies).
#pragma once
#include "engine/command_line/run_command_line.h"

namespace insula {

void add_study_command(CommandLine& line);

}  // namespace insula
