// SPDX-License-Identifier: GPL-3.0-or-later
// What a component can be asked for while the scene runs: by an instructor, a script, a complication. Declared by the
// component; the instructor's page and the reference are made from the declaration.
#pragma once
#include <string>
#include <vector>

namespace insula {

struct CommandInfo {
  std::string name;      ///< "rupture", "set_systolic"
  std::string doc;       ///< one line, for the instructor
  std::string argument;  ///< "" none; else its name with unit: "pressure_mmHg", "text"
  double min = 0, max = 0;  ///< range of a numeric argument; both 0: no number
};

}  // namespace insula
