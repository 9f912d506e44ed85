// SPDX-License-Identifier: GPL-3.0-or-later
// insula play: engine, haptic server and gateway, watched over until the session ends.
#pragma once
#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "core/registry/registry.h"
#include "engine/command_line/commands.h"

namespace insula {

struct PlayOptions {
  std::filesystem::path scene;       ///< empty: the first training exercise
  std::string motion;                ///< id, CSV file or "none" for simulated hands; empty: the engine's default
  std::string left, right;           ///< devices; empty: the scene's, else the haptic server's default
  int port = 8080;                   ///< the viewer's; following ones are tried when it is busy
  std::vector<std::string> hosts;    ///< names under which other machines' pages may ask for the viewer
  std::string listen = "127.0.0.1";  ///< 0.0.0.0 lets other machines watch
  bool browser = true;               ///< open one when there is a display
  double duration_s = 0;             ///< 0: until Ctrl-C
  std::uint64_t seed = 0;            ///< of the complications; 0: the scene's
  std::filesystem::path
      keep_bundle;               ///< the viewer's bundles go into this folder and stay; empty: they go with the session
  std::filesystem::path report;  ///< folder for the session's reports; empty: none
  bool reload = true;            ///< load the scene again when one of its files is saved
  bool view = false;             ///< the scene to be looked at: time stands still, no hands (insula view)
  std::vector<std::filesystem::path> plugin_paths;  ///< of shared plugins, or folders of them, for the engine
};

/// Checks the scene first: nothing starts when it has errors (status 2).
int cmd_play(const CommandContext& context, const PlayOptions& options);

/// What is in a scene, by name, with units and sizes. Status 0, or 2 when the scene has errors.
int cmd_view_list(const CommandContext& context, const std::filesystem::path& scene);

/// The scene that is played when none is named: beside the program's installation or sources, or below the current
/// folder.
std::filesystem::path default_scene();

}  // namespace insula
