// SPDX-License-Identifier: GPL-3.0-or-later
// What a program asks about itself, on Linux.
#include "core/base/this_process.h"

#include <sys/resource.h>
#include <sys/syscall.h>
#include <unistd.h>

namespace insula {

int process_id() { return ::getpid(); }

std::filesystem::path program_file() {
  std::error_code failed;
  const auto file = std::filesystem::read_symlink("/proc/self/exe", failed);
  return failed ? std::filesystem::path() : file;
}

// On Linux, a priority belongs to a thread, and PRIO_PROCESS takes a thread's number.
void lower_priority_of_this_thread() { ::setpriority(PRIO_PROCESS, id_t(::syscall(SYS_gettid)), 10); }

}  // namespace insula
