// SPDX-License-Identifier: GPL-3.0-or-later
// The engine as a process: steps a scene in real time with hands from DEVICE_STATE, and sends the results to the bus.
#pragma once
#include <atomic>
#include <filesystem>
#include <functional>
#include <map>
#include <optional>
#include <string>

#include "core/bus/bus.h"
#include "core/registry/registry.h"
#include "core/sim/simulation.h"
#include "engine/live/session_mode.h"
#include "engine/live/step_rate.h"

namespace insula {

struct LiveOptions {
  std::filesystem::path scene;
  std::string motion = "steady";      ///< id of a motion of the exercise, a CSV file, or "none", for simulated hands
  std::filesystem::path bundle_root;  ///< folder for viewer bundles; empty: the user's runtime folder
  double duration = 0;                ///< simulated seconds; 0: until asked to stop
  StepRate rate;                      ///< of the steps; it stays for the session
  bool unthrottled = false;           ///< as fast as the machine can, for measurements
  int threads = 0;
  std::uint64_t seed = 0;        ///< of the complications; 0: the scene's
  bool keep_bundle = false;      ///< keep the viewer's bundle at the end, for a replay
  bool still = false;            ///< only show the scene: time stands still, the bundle has the inventory
  std::filesystem::path notice;  ///< file whose text viewers show over the image while it is not empty; none: nothing
  std::filesystem::path report;  ///< folder for the session's reports (session_reports.h); empty: none
  std::filesystem::path store;   ///< training store that keeps each run that has a report; empty: none
  std::filesystem::path record;  ///< session file, or the folder of a new one (new_session_file()); empty: none
  std::filesystem::path bands;   ///< of `insula bands --json`, for the reports; empty: none
  std::string band_group;        ///< whose bands; empty: the only group
  std::map<std::string, std::string> fields;  ///< what the person says of the session (SessionAbout)
  /// How the session begins. None: as a demonstration if there is a motion, else as practice. A scene without an
  /// exercise never waits.
  std::optional<SessionMode> mode;
  /// Called once when the scene is loaded and settled, before anything is sent. It may wait. False: end without a
  /// message.
  std::function<bool()> take_over;
};

/// Runs until `stop` is set, the duration is over or a viewer quits. Exit status: 0, or 2 if the scene has errors.
int run_live(const LiveOptions& options, const Registry& registry, Bus& bus, const std::atomic<bool>& stop);

/// The file of a motion named by id in the scene's exercise, or a path; empty for "none". Throws InputError with a list
/// of the motions.
std::filesystem::path find_motion(const Simulation& simulation, const std::string& id_or_file);

}  // namespace insula
