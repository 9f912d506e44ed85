// SPDX-License-Identifier: GPL-3.0-or-later
// How many steps the engine makes in a second of a session: the scene's own number, a given one, or the highest that
// this machine keeps with a margin. It is chosen before the first step and stays for the session.
#pragma once
#include <array>
#include <string>

#include "core/registry/registry.h"
#include "core/sim/simulation.h"

namespace insula {

/// As given on the command line.
struct StepRate {
  double hz = 0;           ///< 0: the scene's own
  bool automatic = false;  ///< the highest of automatic_rates_hz that fits; hz is 0

  /// For load_simulation(); 0: the scene's own.
  double step_s() const { return hz > 0 ? 1 / hz : 0; }
};

inline constexpr double slowest_rate_hz = 20, fastest_rate_hz = 1000;
/// Rates to choose from, highest first. The last one is taken if none fits.
inline constexpr std::array automatic_rates_hz = {480.0, 240.0, 120.0, 60.0};
/// A step may take this share of its period in the trial. The rest is for steps with more contacts than the trial has,
/// and for the haptic server, the gateway and a browser on the same machine.
inline constexpr double trial_share = 0.5;

/// "auto", "120 Hz" or "120"; empty: the scene's own. Throws InputError if the text is anything else or out of range.
StepRate read_step_rate(const std::string& text);

/// The highest rate of automatic_rates_hz whose period holds a step of this cost.
double highest_rate_hz(double step_ms);

/// Loads the scene with the wanted rate. An automatic one is chosen by a trial of two seconds, in which the
/// hands follow the exercise's motion; after it the simulation is as freshly loaded. `said`: one line about the choice;
/// empty if there was none.
SimulationResult load_at_rate(const std::filesystem::path& scene, const Registry& registry, int threads, StepRate rate,
                              std::string& said);

}  // namespace insula
