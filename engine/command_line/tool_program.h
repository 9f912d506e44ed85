// SPDX-License-Identifier: GPL-3.0-or-later
// Commands of separate programs, which need libraries or code that a trainee's session does not.
#pragma once
#include <iosfwd>
#include <string>
#include <vector>

namespace insula {

/// Replaces this process by the program of that name beside it, with these arguments. Returns only if that fails, with
/// status 1 and the reason on `err`. `when_missing`: how to get the program.
int run_tool_program(const std::string& name, const std::vector<std::string>& arguments,
                     const std::string& when_missing, std::ostream& err);

}  // namespace insula
