// SPDX-License-Identifier: GPL-3.0-or-later
// Where the data of this machine's user is: recordings, persons, runs.
#pragma once
#include <filesystem>

namespace insula::training {

struct DataFolder {
  std::filesystem::path root;  ///< absolute
  std::filesystem::path sessions() const { return root / "sessions"; }
  std::filesystem::path store() const { return root / "training.sqlite"; }
};

/// The given folder; if it is empty, `insula` in the platform's folder for user data ($XDG_DATA_HOME, else
/// ~/.local/share).
DataFolder data_folder(const std::filesystem::path& given = {});

}  // namespace insula::training
