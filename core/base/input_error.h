// SPDX-License-Identifier: GPL-3.0-or-later
// Thrown by readers of files for input that cannot be used. The text is meant for the person who made the file.
#pragma once
#include <stdexcept>

namespace insula {

struct InputError : std::runtime_error {
  using std::runtime_error::runtime_error;
};

}  // namespace insula
