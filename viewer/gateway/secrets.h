// SPDX-License-Identifier: GPL-3.0-or-later
// What admits pages and programs of other machines. Secrets come from files, so that no list of processes shows them.
#pragma once
#include <filesystem>
#include <string>

namespace insula::gateway {

struct Secrets {
  std::string pin;           ///< admits instructors; empty: none
  std::string observer_pin;  ///< admits observers; empty: none
  std::string key;           ///< admits programs and the instructor's own gateway; empty: none
};

/// 32 to 128 letters, digits, "-" and "_".
bool is_key(const std::string& text);

/// A random key.
std::string new_key();

/// Reads {"pin", "observer_pin"}. Throws InputError if the file is malformed or others than its owner may read it.
void read_pins(const std::filesystem::path& file, Secrets& secrets);
/// Reads a key: one line. Throws as read_pins().
void read_key(const std::filesystem::path& file, Secrets& secrets);

}  // namespace insula::gateway
