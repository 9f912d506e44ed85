// SPDX-License-Identifier: GPL-3.0-or-later
#include "training/xapi/sender_lock.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/file.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>

#include "core/base/input_error.h"

namespace insula::xapi {

SenderLock::SenderLock(const std::filesystem::path& store) {
  const std::string file = store.string() + ".sender";
  descriptor_ = ::open(file.c_str(), O_RDWR | O_CREAT | O_CLOEXEC | O_NOFOLLOW, 0600);
  if (descriptor_ < 0) throw InputError(fmt::format("{}: {}", file, std::strerror(errno)));
}

// The file stays: who removed it could remove the lock of a sender that has just started.
SenderLock::~SenderLock() { ::close(descriptor_); }

bool SenderLock::take() const { return ::flock(descriptor_, LOCK_EX | LOCK_NB) == 0; }

}  // namespace insula::xapi
