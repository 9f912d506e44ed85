// SPDX-License-Identifier: GPL-3.0-or-later
// The commands for recorded sessions: rerun, score, bands, session.
#pragma once
#include <filesystem>
#include <string>
#include <vector>

#include "engine/command_line/commands.h"
#include "engine/command_line/run_command_line.h"

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

struct ScoreOptions {
  std::vector<std::filesystem::path> files;
  std::filesystem::path rules;                ///< scene whose rules and metrics are used; empty: the recorded ones
  std::vector<std::filesystem::path> places;  ///< as for rerun
  int threads = 0;
  bool json = false;
};
/// Scores sessions again. Status 0 if every run and, with the recorded rules, every metric has the recorded bits; 1 if
/// one differs; 2 if one cannot be scored. The worst one counts.
int cmd_score(const CommandContext& context, const ScoreOptions& options);

struct BandsOptions {
  std::filesystem::path folder;  ///< searched for sessions, with the folders in it
  std::string group;             ///< field of a session that names its group: "level", "mode", "person"
  std::string title;             ///< of the exercise; empty: there must be only one
  std::string pass_group;        ///< group whose values give the pass mark; empty: none
  double pass_share = -1;        ///< quantile of that group; negative: its mean
  bool json = false;
};
/// Bands of the metrics in each group. Status 0, or 2 if no session could be used.
int cmd_bands(const CommandContext& context, const BandsOptions& options);

struct SessionOptions {
  std::filesystem::path file;
  bool json = false;
};
struct ExportOptions {
  std::filesystem::path file;
  std::filesystem::path folder;  ///< is created
  std::string format = "csv";    ///< "csv", "json", "parquet" or "lcm"
};
/// Writes the tables of a session: hands, channels, metrics, events. Status 0; 1 if a file cannot be written; 2 if it
/// is no session.
int cmd_session_export(const CommandContext& context, const ExportOptions& options);

struct ForgetOptions {
  std::string person;
  std::vector<std::filesystem::path> folders;  ///< of sessions and of reports
  std::filesystem::path data;                  ///< folder of the user's data; empty: the platform's
  bool list_only = false;
};
/// Removes all sessions and reports of a person. Status 0, also if there are none; 1 if one cannot be removed.
int cmd_session_forget(const CommandContext& context, const ForgetOptions& options);

/// What a session file contains. Status 0; 2 if it is no session.
int cmd_session_info(const CommandContext& context, const SessionOptions& options);
/// Reads the whole file and lists its damage. Status 0 if there is none; 1 if there is some; 2 if it is no session.
int cmd_session_verify(const CommandContext& context, const SessionOptions& options);

/// Adds all of these commands to the program.
void add_session_commands(CommandLine& line);

}  // namespace insula
