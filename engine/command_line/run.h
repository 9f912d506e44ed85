// SPDX-License-Identifier: GPL-3.0-or-later
// The commands that step a scene: run (headless, with a report), engine (the live process).
#pragma once
#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "engine/command_line/commands.h"

namespace insula {

struct RunOptions {
  std::filesystem::path scene;
  std::string motion = "none";   ///< id of a motion of the exercise, CSV file, or none
  double duration = 0;           ///< simulated seconds; 0: the motion and one more second, or 10 s without a motion
  std::string rate;              ///< steps a second; empty: the scene's
  std::filesystem::path report;  ///< folder for report.json and report.html; empty: none
  std::filesystem::path export_folder;  ///< folder for the bodies' final nodes as .vtu; empty: none
  std::filesystem::path record;         ///< session file; empty: none
  std::filesystem::path bands;          ///< of `insula bands --json`, for the report; empty: none
  std::string band_group;               ///< whose bands; empty: the only group
  std::vector<std::string> fields;      ///< NAME=VALUE, of the recording
  int threads = 0;
  std::uint64_t seed = 0;  ///< of the complications; 0: the scene's
  bool quiet = false;
};
/// Runs a scene headless and deterministic with both hands inside the process. Status 0; 2 for bad input; 1 if the
/// simulation became infinite or a file could not be written.
int cmd_run(const CommandContext& context, const RunOptions& options);

struct EngineOptions {
  std::filesystem::path scene;
  std::string motion = "steady";
  std::filesystem::path bundle_root;
  double duration = 0;
  std::string rate;  ///< steps a second, or auto; empty: the scene's
  bool unthrottled = false;
  int threads = 0;
  std::uint64_t seed = 0;
  bool keep_bundle = false;      ///< keep the bundle for a replay
  bool still = false;            ///< only show the scene (insula view)
  bool standby = false;          ///< load, print standby_line, and wait for SIGUSR1 before anything is sent on the bus
  std::filesystem::path notice;  ///< file whose text viewers show while it is not empty
  std::filesystem::path report;  ///< folder for the session's reports; empty: none
  std::filesystem::path store;   ///< training store for the session's runs; empty: none
  std::filesystem::path record;  ///< session file, or folder of a new one; empty: none
  std::filesystem::path bands;   ///< as for run
  std::string band_group;
  std::vector<std::string> fields;  ///< NAME=VALUE, of the recording
  std::string mode;  ///< name of the SessionMode in which it begins; empty: a demonstration if there is a motion
};
inline constexpr const char* standby_line = "insula engine stands by";
/// The engine process of a session. It uses the bus of LCM_DEFAULT_URL until SIGINT or SIGTERM.
int cmd_engine(const CommandContext& context, const EngineOptions& options);

struct ReplayOptions {
  std::vector<std::filesystem::path> files;  ///< recorded sessions (NAME.insula), or one log of lcm-logger
  int port = 8080;                           ///< of the page, for sessions
  double speed = 1;                          ///< of a log
  bool loop = false;                         ///< of a log
};
/// Serves the page of recorded sessions, two of them side by side. A log of lcm-logger instead goes to the bus: those
/// of its messages that viewers show.
int cmd_replay(const CommandContext& context, const ReplayOptions& options);

}  // namespace insula
