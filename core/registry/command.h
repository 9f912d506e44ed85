// SPDX-License-Identifier: GPL-3.0-or-later
// A command that a component accepts while the scene runs, from an instructor, a script or a complication. The
// component declares it. The instructor's page and the reference are made from the declaration.
#pragma once
#include <string>
#include <vector>

namespace insula {

struct CommandInfo {
  std::string name;         ///< "rupture", "set_systolic"
  std::string doc;          ///< one line, for the instructor
  std::string argument;     ///< empty: none; else its name with unit: "pressure_mmHg", "text"
  double min = 0, max = 0;  ///< range of a numeric argument; both 0: no number
};

}  // namespace insula
