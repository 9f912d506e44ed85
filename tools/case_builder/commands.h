// SPDX-License-Identifier: GPL-3.0-or-later
// insula case ...: the command line of the case builder.
#pragma once
#include <cstdio>
#include <string>
#include <vector>

namespace insula::case_builder {

/// Arguments without the program's name; progress and errors go to `err`, what was made to `out`. Status: 0 well, 1 the
/// system's fault, 2 the input's.
int run_command(const std::vector<std::string>& arguments, std::FILE* out, std::FILE* err);

}  // namespace insula::case_builder
