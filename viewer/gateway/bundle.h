// SPDX-License-Identifier: GPL-3.0-or-later
// The files of the present scene bundle (docs/scene-bundle.md) that may be served.
#pragma once
#include <cstdint>
#include <filesystem>
#include <optional>
#include <set>
#include <string>
#include <vector>

namespace insula::gateway {

/// The bus gives the folder, and any sender on the bus could give any folder. So only scene.json and the files that it
/// lists are served, and only from within the folder.
class Bundle {
 public:
  void set(std::int64_t session, const std::string& folder);
  /// The file of /bundle/<session>/<parts>, or nothing.
  std::optional<std::filesystem::path> find(const std::string& session, const std::vector<std::string>& parts);

 private:
  void refresh();

  std::int64_t session_ = -1;
  std::filesystem::path folder_;
  std::filesystem::file_time_type read_at_{};  // last change of scene.json when `listed_` was made
  std::set<std::string> listed_;
};

}  // namespace insula::gateway
