// SPDX-License-Identifier: GPL-3.0-or-later
// Names of files and scenes as a person reads them.
#pragma once
#include <algorithm>
#include <string>

namespace insula {

/// "blood_loss" is read as "blood loss".
inline std::string spoken(std::string name) {
  std::replace(name.begin(), name.end(), '_', ' ');
  return name;
}

}  // namespace insula
