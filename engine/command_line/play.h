// SPDX-License-Identifier: GPL-3.0-or-later
// insula play: engine, haptic server and gateway, supervised until the session ends.
#pragma once
#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "core/registry/registry.h"
#include "engine/command_line/commands.h"
#include "engine/command_line/play_room.h"
#include "engine/command_line/record_store_options.h"

namespace insula {

struct PlayOptions {
  std::filesystem::path scene;       ///< empty: the first training exercise
  std::string motion;                ///< id, CSV file or "none" for simulated hands; empty: the engine's default
  std::string mode;                  ///< name of the SessionMode in which it begins; empty: chosen on the page
  std::string left, right;           ///< devices; empty: those of the scene, else the haptic server's default
  int port = 8080;                   ///< the viewer's; if it is busy, the next ones are tried
  std::vector<std::string> hosts;    ///< names by which pages of other machines may address the viewer
  std::string listen = "127.0.0.1";  ///< 0.0.0.0 lets other machines watch
  RoomOptions room;                  ///< who else is admitted
  bool browser = true;               ///< opens a browser if there is a display
  double duration_s = 0;             ///< 0: until Ctrl-C
  std::string rate;                  ///< steps a second of the engine, or auto; empty: the scene's
  std::uint64_t seed = 0;            ///< of the complications; 0: the scene's
  std::filesystem::path
      keep_bundle;               ///< folder in which the viewer's bundles are kept; empty: they are removed at the end
  std::filesystem::path report;  ///< folder for the session's reports; empty: none
  std::filesystem::path data;    ///< folder of the user's data; empty: the platform's
  std::filesystem::path store;   ///< training store for the session's runs; empty: none
  std::filesystem::path record;  ///< session file, or folder of a new one; empty: nothing is recorded
  std::filesystem::path bands;   ///< of `insula bands --json`, for the reports; empty: none
  std::string band_group;        ///< whose bands; empty: the only group
  std::vector<std::string> fields;                  ///< NAME=VALUE, of the recording
  RecordStoreOptions records;                       ///< to send attempts to
  bool start_page = false;                          ///< the viewer begins with the start page
  bool reload = true;                               ///< loads the scene again when one of its files is saved
  bool view = false;                                ///< shows the scene: time stands still, no hands (insula view)
  std::vector<std::filesystem::path> plugin_paths;  ///< shared plugins, or folders of them, for the engine
};

/// Checks the scene first. If it has errors, nothing starts (status 2).
int cmd_play(const CommandContext& context, const PlayOptions& options);

/// Lists the inventory of a scene. Status 0, or 2 if the scene has errors.
int cmd_view_list(const CommandContext& context, const std::filesystem::path& scene);

/// Prints what persons read of scenes and curricula as JSON, each text once: [{"text": ..., "kind": "goal"}]. Status 0,
/// or 2 if a file has errors; then its texts are missing.
int cmd_texts(const CommandContext& context, const std::vector<std::filesystem::path>& files);

/// Folder of the reports if none is given: `reports` in the given folder of the user's data; if that is empty too,
/// insula-reports in the home folder, or in the current one.
std::filesystem::path default_report_folder(const std::filesystem::path& data);
/// The folders that `play` writes recordings and reports to if none are given.
std::vector<std::filesystem::path> folders_of_play(const std::filesystem::path& data);

/// The scene that is played if none is given. It is beside the program's installation or sources, or below the current
/// folder.
std::filesystem::path default_scene();

}  // namespace insula
