// SPDX-License-Identifier: GPL-3.0-or-later
// Steps a simulation from a recording's inputs and compares its state with the recorded one.
#pragma once
#include <cstdint>
#include <filesystem>
#include <functional>
#include <string>
#include <vector>

#include "core/registry/registry.h"
#include "core/sim/simulation.h"
#include "engine/session/session_reader.h"

namespace insula {

struct RerunResult {
  std::int64_t steps = 0;         ///< that were made
  std::int64_t compared = 0;      ///< states of the recording that were reached
  std::int64_t different = 0;     ///< those of them with other bits; with other instructions: beyond the tolerance
  double first_different_s = -1;  ///< time in the recording of the first one, s; negative: none
  bool same_instructions = true;  ///< the recording's instruction set and devices; with others the bits differ
  std::vector<std::string> missing_devices = {};  ///< body and device of the recording that this machine does not have
  double largest_change = 0;  ///< with other instructions: of energy and the bodies' sums, over their size
  std::string broken;         ///< why the rerun ended early; empty: it did not
  /// Whether every state was reached and is the same.
  bool good() const { return broken.empty() && compared > 0 && different == 0; }
};

struct RerunSettings {
  std::vector<std::filesystem::path> places =
      {};  ///< where meshes are; also searched: the folder of the recording's scene
  int threads = 0;
  double tolerance = 1e-3;           ///< of largest_change
  std::filesystem::path rules = {};  ///< scene whose exercise takes the place of the recorded one; empty: none
};

/// after: called after each step. at_end: after the last one. Both may be empty. Throws InputError if the scene cannot
/// be restored or loaded.
RerunResult rerun(SessionReader& session, const Registry& registry, const RerunSettings& settings,
                  const std::function<void(const Simulation&)>& after = {},
                  const std::function<void(const Simulation&)>& at_end = {});

}  // namespace insula
