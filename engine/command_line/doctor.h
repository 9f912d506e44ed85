// SPDX-License-Identifier: GPL-3.0-or-later
// The command `insula doctor`: what this machine has for the program and what it lacks, with the remedy.
#pragma once
#include <string>
#include <vector>

#include "engine/command_line/commands.h"

namespace insula {

enum class Fitness { good, lacking, unusable };  ///< lacking: works, but worse or without a part

struct MachineFinding {
  std::string id;  ///< stable: "real_time", "bus", ...
  Fitness fitness = Fitness::good;
  std::string text;    ///< what was found
  std::string remedy;  ///< empty where nothing is lacking
};

/// Looks at the machine: processor, memory, the bus, rights for the servo, programs, page, browser, graphics, devices.
/// Takes a second at most, and changes nothing.
std::vector<MachineFinding> examine_machine();

/// Prints the findings, as JSON if `json`: {"fit", "findings": [{id, fitness, text, remedy}]}. Returns 0, or 1 if the
/// program cannot be used as the machine is.
int cmd_doctor(const CommandContext& context, bool json);

}  // namespace insula
