// SPDX-License-Identifier: GPL-3.0-or-later
#include "engine/live/step_rate.h"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <vector>

#include "core/base/input_error.h"
#include "core/params/option.h"
#include "core/sim/exercise.h"
#include "engine/live/headless.h"
#include "engine/reports/report_writer.h"

namespace insula {
namespace {

/// The trial ends after this time of the wall clock, or after so many steps.
constexpr double trial_s = 2;
constexpr int most_steps = 2000;
/// Of the trial's steps, this share is quicker than the returned one.
constexpr double trial_quantile = 0.95;

/// The motion that is shown to trainees, or else the first; none: the tools stay at their homes.
Motion trial_motion(const Simulation& simulation) {
  const Exercise* exercise = simulation.exercise();
  if (!exercise || exercise->motions().empty()) return {};
  const auto& all = exercise->motions();
  const auto guide = std::find_if(all.begin(), all.end(), [](const MotionEntry* m) { return m->guide(); });
  try {
    return load_motion((guide == all.end() ? all.front() : *guide)->file());
  } catch (const InputError&) {
    return {};  // the session says so
  }
}

/// Wall time of a step while the hands follow the motion, ms. The simulation is reset.
double trial_step_ms(Simulation& simulation) {
  HeadlessRun run(simulation, trial_motion(simulation));
  std::vector<double> ms;
  const auto began = std::chrono::steady_clock::now();
  do {
    run.step();
    ms.push_back(simulation.report().step_ms);
  } while (int(ms.size()) < most_steps &&
           std::chrono::steady_clock::now() - began < std::chrono::duration<double>(trial_s));
  run.reset();
  return percentile(std::move(ms), trial_quantile);
}

}  // namespace

StepRate read_step_rate(const std::string& text) {
  if (text.empty()) return {};
  if (text == "auto") return {0, true};
  const std::string low = fmt::format("{} Hz", slowest_rate_hz), high = fmt::format("{} Hz", fastest_rate_hz);
  std::string error;
  const QuantityOption option{.bare = "Hz", .min = low, .max = high, .doc = {}};
  const auto hz = read_option(text, Frequency::units(), Frequency::name, option, error);
  if (!hz) throw InputError(error + " (or auto)");
  return {*hz, false};
}

double highest_rate_hz(double step_ms) {
  for (const double hz : automatic_rates_hz)
    if (step_ms <= trial_share * 1000 / hz) return hz;
  return automatic_rates_hz.back();
}

SimulationResult load_at_rate(const std::filesystem::path& scene, const Registry& registry, int threads, StepRate rate,
                              std::string& said) {
  const StepRate slowest{automatic_rates_hz.back()}, first = rate.automatic ? slowest : rate;
  SimulationResult loaded = load_simulation(scene, registry, threads, first.step_s());
  if (!rate.automatic || !loaded.simulation) return loaded;
  const double step_ms = trial_step_ms(*loaded.simulation);
  const StepRate chosen{highest_rate_hz(step_ms)};
  said = fmt::format("{} steps a second: a step of the trial takes {:.2f} ms of {:.2f} ms", chosen.hz, step_ms,
                     1000 * chosen.step_s());
  if (chosen.hz == slowest.hz) return loaded;
  return load_simulation(scene, registry, threads, chosen.step_s());
}

}  // namespace insula
