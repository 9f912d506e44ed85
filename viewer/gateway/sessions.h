// SPDX-License-Identifier: GPL-3.0-or-later
// Recorded sessions that pages on this machine may look at, and the notes beside them.
#pragma once
#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace insula::gateway {

class Sessions {
 public:
  Sessions() = default;
  /// folder: all recordings in it are offered; empty: none. files: others, wherever they are.
  Sessions(std::filesystem::path folder, const std::vector<std::filesystem::path>& files);

  /// Names of the files that were given one by one, in their order.
  const std::vector<std::string>& given() const { return given_; }
  /// JSON: a list of {name, bytes}, the newest first.
  std::string list() const;
  /// The recording of a name from the list.
  std::optional<std::filesystem::path> find(const std::string& name) const;

  /// Largest text of notes, bytes.
  static constexpr std::size_t most_notes_bytes = 256u << 10;
  /// Notes beside a recording, as JSON; "[]" if there are none.
  static std::string notes(const std::filesystem::path& recording);
  /// Replaces them. Returns what is wrong with the text, or why it cannot be written; empty: it is stored.
  static std::string store_notes(const std::filesystem::path& recording, std::string_view json);

 private:
  std::map<std::string, std::filesystem::path> all() const;

  std::filesystem::path folder_;
  std::map<std::string, std::filesystem::path> files_;  ///< by name
  std::vector<std::string> given_;
};

}  // namespace insula::gateway
