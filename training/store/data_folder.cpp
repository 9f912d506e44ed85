// SPDX-License-Identifier: GPL-3.0-or-later
#include "training/store/data_folder.h"

#include <cstdlib>

namespace insula::training {
namespace fs = std::filesystem;

DataFolder data_folder(const fs::path& given) {
  if (!given.empty()) return {fs::absolute(given)};
  const char* data = std::getenv("XDG_DATA_HOME");
  const char* home = std::getenv("HOME");
  const fs::path base = data && *data   ? fs::path(data)
                        : home && *home ? fs::path(home) / ".local/share"
                                        : fs::path(".");
  return {fs::absolute(base) / "insula"};
}

}  // namespace insula::training
