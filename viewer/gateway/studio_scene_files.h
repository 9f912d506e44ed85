// SPDX-License-Identifier: GPL-3.0-or-later
// Copies of scenes that an author edits, each in a folder of its own. Only XML files in them are read and written, and
// every text that was replaced is kept.
#pragma once
#include <cstdint>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <vector>

namespace insula::gateway {

class StudioSceneFiles {
 public:
  explicit StudioSceneFiles(std::filesystem::path root) : root_(std::move(root)) {}

  std::vector<std::string> names() const;
  bool has(const std::string& name) const;
  std::filesystem::path folder(const std::string& name) const { return root_ / name; }
  /// Its scenes, and all XML files: paths below its folder.
  std::vector<std::string> scenes(const std::string& name) const;
  std::vector<std::string> files(const std::string& name) const;
  /// Its other files, which the scenes may name.
  std::vector<std::string> meshes(const std::string& name) const;

  struct Text {
    std::string text;
    std::optional<std::string> draft;  ///< was typed and has errors; missing: nothing else was typed
    nlohmann::json versions;           ///< [{number, time_ms}], the newest first

    /// Another one for other texts: a page says with it what it has seen.
    std::string revision() const;
  };
  /// Nothing if there is no such file in the copy.
  std::optional<Text> read(const std::string& name, const std::string& file) const;
  std::optional<std::string> version(const std::string& name, const std::string& file, int number) const;
  /// In one go. The text before becomes a version, and the draft goes. False if there is no such file. Throws
  /// InputError if it cannot be written.
  bool write(const std::string& name, const std::string& file, const std::string& text) const;
  /// Keeps what is typed, apart from the scene. False if there is no such file.
  bool keep_draft(const std::string& name, const std::string& file, const std::string& text) const;
  /// A second copy with another text of one file, to be checked. Its files are links where that is possible. Nothing
  /// if there is no such file. Throws InputError if it cannot be made.
  std::optional<std::filesystem::path> for_check(const std::string& name, const std::string& file,
                                                 const std::string& text) const;
  void remove(const std::string& name) const;

 private:
  /// Paths below the folder, of XML files or of all others.
  std::vector<std::string> listed(const std::string& name, bool xml) const;
  bool holds(const std::string& name, const std::string& file) const;
  std::filesystem::path kept(const std::string& name, const std::string& file) const;

  std::filesystem::path root_;
};

}  // namespace insula::gateway
