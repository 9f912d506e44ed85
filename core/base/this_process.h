// SPDX-License-Identifier: GPL-3.0-or-later
// What a program asks about itself. The implementation belongs to the operating system (platform/).
#pragma once
#include <filesystem>

namespace insula {

/// A number that no other running process of this machine has.
int process_id();
/// The file that this process runs; empty if the system does not say.
std::filesystem::path program_file();
/// The calling thread yields to the process's other threads from now on. Without effect where the system refuses it.
void lower_priority_of_this_thread();

}  // namespace insula
