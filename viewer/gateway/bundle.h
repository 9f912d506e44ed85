// SPDX-License-Identifier: GPL-3.0-or-later
// The scene bundle being shown (docs/scene-bundle.md): which of its files may be served.
#pragma once
#include <cstdint>
#include <filesystem>
#include <optional>
#include <set>
#include <string>
#include <vector>

namespace insula::gateway {

/// The bus names the folder, and anyone on the bus could name any folder: so only scene.json and what it lists is
/// served, and only from within the folder.
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
