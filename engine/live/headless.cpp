// SPDX-License-Identifier: GPL-3.0-or-later
// Servo and engine in lock-step.
#include "engine/live/headless.h"

#include <chrono>
#include <cmath>
#include <ostream>

#include "core/base/input_error.h"
#include "engine/live/live_engine.h"

namespace insula {
namespace {
std::array<HandHome, 2> homes(const Simulation& simulation) {
  std::array<HandHome, 2> out;
  for (int h = 0; h < 2; ++h)
    if (const Instrument* i = simulation.instrument_of(h)) out[std::size_t(h)] = {true, i->home_pose()};
  return out;
}
}  // namespace

HeadlessRun::HeadlessRun(Simulation& simulation, const Motion& motion)
    : simulation_(simulation), haptics_(motion, homes(simulation)), script_(motion.commands()) {}

void HeadlessRun::step() {
  const auto begin = std::chrono::steady_clock::now();
  const int ticks = std::max(1, int(std::lround(simulation_.h() * 1000)));
  const double start = simulation_.time();
  for (int k = 1; k <= ticks; ++k) haptics_.tick(start + k * simulation_.h() / ticks);
  for (int h = 0; h < 2; ++h) {
    const auto& hand = haptics_.hand(h);
    if (hand.present) simulation_.set_hand(h, {true, hand.device, hand.button1, hand.button2});
  }
  haptic_ms_ = std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - begin).count();
  script_.advance(simulation_);
  simulation_.step();
  haptics_.set_problem(condense_(simulation_.problem(), 240, condensed_), pause_.hands(simulation_));
}

void HeadlessRun::reset() {
  simulation_.reset();
  haptics_.reset();
  script_.reset();
  pause_ = {};
}

OpenedRun open_run(const CommandContext& context, const std::filesystem::path& scene, const std::string& motion,
                   bool optional, int threads) {
  OpenedRun out;
  SimulationResult loaded = load_simulation(scene, context.registry, threads);
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
  out.simulation = std::move(loaded.simulation);
  return out;
}

}  // namespace insula
