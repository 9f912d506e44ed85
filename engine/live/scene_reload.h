// SPDX-License-Identifier: GPL-3.0-or-later
// A session follows its scene's files: when one is saved, a second engine loads the scene beside the first and takes
// over when it is ready. When it has errors the first goes on, and viewers are shown what is wrong.
#pragma once
#include <filesystem>
#include <functional>
#include <string>
#include <string_view>
#include <vector>

#include "engine/live/file_watch.h"
#include "engine/live/supervisor.h"

namespace insula {

class SceneReload {
 public:
  using Print = std::function<void(std::string_view)>;
  /// command: the engine with --standby. plugins: libraries, or folders of them, that are watched too. notice: where
  /// the engines look for the text that viewers are shown; empty: nowhere.
  SceneReload(std::filesystem::path scene, std::vector<std::filesystem::path> plugins, std::vector<std::string> command,
              std::filesystem::path notice, Print print);
  /// To be called again and again.
  void look(Supervisor& supervisor);

 private:
  std::vector<std::filesystem::path> files() const;
  void refused(const std::vector<std::string>& lines, const ChildExit& exit);
  void tell_viewers(const std::string& text);

  std::filesystem::path scene_, notice_;
  std::vector<std::filesystem::path> plugins_;
  std::vector<std::string> command_;
  Print print_;
  FileWatch watch_;
  FileWatch::Clock::time_point next_{};
  bool waiting_ = false;  ///< for an offer to be made
};

}  // namespace insula
