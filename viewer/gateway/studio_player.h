// SPDX-License-Identifier: GPL-3.0-or-later
// The session in which an author plays an exercise of a case that he has built, or looks at a scene that he edits: at
// most one.
#pragma once
#include <chrono>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <string>

#include "core/base/child_process.h"

namespace insula::gateway {

class StudioPlayer {
 public:
  /// program: insula. data: folder of the user's data.
  StudioPlayer(std::filesystem::path program, std::filesystem::path data);

  /// Plays the scene. A session that runs is ended first.
  void play(const std::string& project, const std::filesystem::path& scene);
  /// Shows the scene as `insula view` does. A session that runs is ended first.
  void look_at(const std::string& project, const std::filesystem::path& scene);
  /// Ends the session if it is of that project.
  void end(const std::string& project);
  void look();
  /// {state: "starting" | "running" | "ended", url, error}; null if nothing of the project was played. A running one
  /// has an error if it could not load the saved scene and goes on with the one before.
  nlohmann::json state(const std::string& project) const;

 private:
  void change(const std::string& project, const std::filesystem::path& scene, bool view);
  void start();
  void hear(std::string_view line);

  std::filesystem::path program_, data_;
  ChildProcess child_;
  std::string project_, url_, error_, last_line_;
  std::string reload_error_;      ///< why the scene that was saved last is not shown
  bool tells_of_reload_ = false;  ///< the lines that come are such reasons
  std::filesystem::path next_;    ///< scene that waits for the end of the session before; empty: none
  bool view_ = false;             ///< it is looked at, not played
  std::chrono::steady_clock::time_point kill_at_;
};

}  // namespace insula::gateway
