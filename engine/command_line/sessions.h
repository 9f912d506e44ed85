// SPDX-License-Identifier: GPL-3.0-or-later
// The commands for recorded sessions: rerun, session.
#pragma once
#include <filesystem>
#include <vector>

#include "engine/command_line/commands.h"

namespace insula {

struct RerunOptions {
  std::filesystem::path file;
  std::vector<std::filesystem::path> places;  ///< folders with the scene's meshes; also searched: where it was recorded
  std::filesystem::path report;  ///< folder for the report of the last pass through the exercise; empty: none
  int threads = 0;
  bool quiet = false;
};
/// Steps the engine from a recording and compares its state with the recorded one. Status 0 only if every compared
/// state is the same; 1 if one differs or the recording is damaged; 2 if it cannot be rerun.
int cmd_rerun(const CommandContext& context, const RerunOptions& options);

struct SessionOptions {
  std::filesystem::path file;
  bool json = false;
};
/// What a session file contains. Status 0; 2 if it is no session.
int cmd_session_info(const CommandContext& context, const SessionOptions& options);
/// Reads the whole file and lists its damage. Status 0 if there is none; 1 if there is some; 2 if it is no session.
int cmd_session_verify(const CommandContext& context, const SessionOptions& options);

}  // namespace insula
