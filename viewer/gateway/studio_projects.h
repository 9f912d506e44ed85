// SPDX-License-Identifier: GPL-3.0-or-later
// Projects of the case builder's page on the disk: a folder each, with the author's file as it came, his choices with
// all earlier ones, what was found in the file, and the built case. Every change is written at once and in one go.
#pragma once
#include <cstdint>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <vector>

namespace insula::gateway {

struct StudioProject {
  std::string name, file;               ///< file: its name at the author
  std::string input;                    ///< its path in the folder
  std::vector<nlohmann::json> history;  ///< choices; one at least
  std::size_t at = 0;                   ///< the present ones
  /// Goes up with each change of the choices. A page sends the one that it shows, so that it changes nothing that it
  /// has not seen. A new project begins with the time, so that one of a removed project's name has others.
  std::int64_t revision = 0;
  /// {inspect: {state, error}, build: {state, error, folder, choices, began_ms}, builds}; states: running, done,
  /// failed, cancelled.
  nlohmann::json work;

  const nlohmann::json& choices() const { return history[at]; }
};

inline constexpr const char* project_not_written = "the project cannot be written: is the disk full?";

class StudioProjects {
 public:
  explicit StudioProjects(std::filesystem::path root) : root_(std::move(root)) {}

  /// A name for a project from that of a file: its letters and digits, others as _.
  static std::string name_for(const std::string& file);
  std::filesystem::path folder(const std::string& name) const { return root_ / name; }
  std::vector<std::string> names() const;
  /// Nothing if there is none of that name, or its description cannot be read.
  std::optional<StudioProject> read(const std::string& name) const;
  /// Throws InputError.
  void write(const StudioProject& project) const;
  /// Where a file is put while it comes.
  std::filesystem::path incoming_folder() const { return root_ / ".incoming"; }
  /// A new project with its file, which is moved there as `input`. If the name is taken, it gets a number. Throws
  /// InputError.
  StudioProject create(const std::string& file, const std::string& input, const std::filesystem::path& content) const;
  void remove(const std::string& name) const;

 private:
  std::filesystem::path root_;
};

/// Makes choices the present ones. Later ones, which had been undone, go.
void choose(StudioProject& project, nlohmann::json choices);
/// The choices before, or those that were undone last; nothing if there are none.
void undo(StudioProject& project);
void redo(StudioProject& project);

}  // namespace insula::gateway
