// SPDX-License-Identifier: GPL-3.0-or-later
// Servo and engine in lock-step.
#include "engine/live/headless.h"

#include <chrono>
#include <ostream>

#include "core/base/input_error.h"
#include "engine/live/live_engine.h"
#include "engine/live/motion_start.h"

namespace insula {

HeadlessRun::HeadlessRun(Simulation& simulation, const Motion& motion)
    : simulation_(simulation), hands_(simulation, motion), script_(motion.commands()) {}

void HeadlessRun::step() {
  const auto begin = std::chrono::steady_clock::now();
  hands_.before_step(simulation_);
  haptic_ms_ = std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - begin).count();
  script_.advance(simulation_);
  simulation_.step();
  hands_.after_step(simulation_);
}

void HeadlessRun::reset() {
  simulation_.reset();
  hands_.reset();
  script_.reset();
}

OpenedRun open_run(const CommandContext& context, const std::filesystem::path& scene, const std::string& motion,
                   bool optional, int threads, double time_step_s) {
  OpenedRun out;
  SimulationResult loaded = load_simulation(scene, context.registry, threads, time_step_s);
  context.err << loaded.diagnostics.format();
  if (!loaded.simulation) return out;
  try {
    const auto file = find_motion(*loaded.simulation, motion);
    if (!file.empty()) out.motion = load_motion(file);
  } catch (const InputError& e) {
    if (!optional) {
      context.err << scene.string() << ": error: " << e.what() << '\n';
      return out;
    }
  }
  try {
    check_start(*loaded.simulation, out.motion);
  } catch (const InputError& e) {
    context.err << scene.string() << ": error: " << e.what() << '\n';
    return out;
  }
  out.simulation = std::move(loaded.simulation);
  return out;
}

}  // namespace insula
