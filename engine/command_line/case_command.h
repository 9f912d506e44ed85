// SPDX-License-Identifier: GPL-3.0-or-later
// insula case ...: the case builder is a program of its own, since it needs libraries that nothing else does.
#pragma once
#include <iosfwd>
#include <string>
#include <vector>

namespace insula {

/// Hands over to the program insula_case beside this one, and does not come back. Status 1, with a message, when it is not there.
int cmd_case(const std::vector<std::string>& arguments, std::ostream& err);

}  // namespace insula
