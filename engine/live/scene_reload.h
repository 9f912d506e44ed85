// SPDX-License-Identifier: GPL-3.0-or-later
// Reloads a session's scene when one of its files is saved. A second engine loads the scene beside the first one and
// takes over when it is ready. If the scene has errors, the first engine continues, and viewers show the errors.
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
  /// command: the engine with --standby. plugins: libraries, or folders of them, that are also watched. notice: file
  /// from which the engines read the text for viewers; empty: none.
  SceneReload(std::filesystem::path scene, std::vector<std::filesystem::path> plugins, std::vector<std::string> command,
              std::filesystem::path notice, Print print);
  /// Another scene from now on, with the command of its engine.
  void watch(std::filesystem::path scene, std::vector<std::string> command);
  /// Must be called repeatedly.
  void look(Supervisor& supervisor);

 private:
  std::vector<std::filesystem::path> files() const;
  void refused(const std::string& why);
  void tell_viewers(const std::string& text);

  std::filesystem::path scene_, notice_;
  std::vector<std::filesystem::path> plugins_;
  std::vector<std::string> command_;
  Print print_;
  FileWatch watch_;
  FileWatch::Clock::time_point next_{};
  bool waiting_ = false;  ///< an offer could not be made yet
};

}  // namespace insula
