// SPDX-License-Identifier: GPL-3.0-or-later
// Files that hold a secret.
#pragma once
#include <filesystem>

#include "core/base/input_error.h"

namespace insula {

/// Throws an InputError unless it is a file that its owner alone can read.
inline void check_private(const std::filesystem::path& file) {
  namespace fs = std::filesystem;
  std::error_code error;
  const fs::file_status status = fs::status(file, error);
  if (error || !fs::is_regular_file(status)) throw InputError(file.string() + " is no file that can be read");
  constexpr fs::perms of_others = fs::perms::group_all | fs::perms::others_all;
  if ((status.permissions() & of_others) != fs::perms::none)
    throw InputError("others may read " + file.string() + "; chmod 600 " + file.string());
}

}  // namespace insula
