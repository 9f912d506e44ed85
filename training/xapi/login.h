// SPDX-License-Identifier: GPL-3.0-or-later
// The name and the password of an account at a learning record store. They are never on a command line, where other
// users of the machine could read them.
#pragma once
#include <filesystem>
#include <string>

namespace insula::xapi {

struct Login {
  std::string user, password;  ///< both empty: requests carry none
};

/// From a file with one line NAME:PASSWORD, which nobody but its owner may read; if the path is empty, from the
/// variables INSULA_LRS_USER and INSULA_LRS_PASSWORD. Throws InputError if the file cannot be read, if others may read
/// it, or if a part is missing.
Login read_login(const std::filesystem::path& file);

}  // namespace insula::xapi
