// SPDX-License-Identifier: GPL-3.0-or-later
// insula bench --haptics: the servo's force against the engine stepped at 1 kHz.
#include <fmt/ostream.h>

#include <algorithm>
#include <cmath>

#include "core/base/input_error.h"
#include "core/params/param.h"
#include "engine/live/live_engine.h"
#include "engine/live/motion_start.h"
#include "engine/live/publisher.h"
#include "tools/workbench/haptic_truth.h"
#include "tools/workbench/workbench.h"

namespace insula {
namespace {

/// From the poses to the problem's arrival: in steps, or a time.
struct Latency {
  double steps = 0, seconds = 0;
  double at(double step_s) const { return seconds + steps * step_s; }
};
Latency read_latency(std::string text) {
  const bool bare = text.find_first_not_of("0123456789.") == std::string::npos;
  if (bare) text += " s";  // read alike; what it counts is steps
  else if (const auto unit = text.find_first_not_of("0123456789."); unit > 0 && text[unit] != ' ')
    text.insert(unit, " ");
  std::string error;
  const auto value = parse_quantity(text, Duration::units(), Duration::name, error);
  if (!value || *value < 0 || *value > (bare ? 3 : 0.2))
    throw InputError("--latency: " + (value ? std::string("0 to 3 steps, or 0 to 200 ms") : error));
  return bare ? Latency{*value, 0} : Latency{0, *value};
}

struct Variant {
  const char* name;
  ReplaySettings settings;
  bool predicted = true;  ///< contacts turned by the engine to where they are when the problem arrives
};

std::vector<Variant> variants(bool ablation) {
  ReplaySettings held, diagonal, servo, hindsight;
  held.rendering = Rendering::held;
  diagonal.rendering = Rendering::diagonal;
  hindsight.rendering = Rendering::hindsight;
  std::vector<Variant> out{{"held", held}, {"diagonal of W", diagonal, false}, {"equation 7", servo, false}};
  const ServoSettings full = ServoSettings::beyond_equation_7();
  if (ablation) {
    servo.servo.substep.incremental_slip = full.substep.incremental_slip;
    out.push_back({"+ incremental slip", servo, false});
    servo.servo.substep.extrapolate_tissue = full.substep.extrapolate_tissue;
    out.push_back({"+ tissue extrapolation", servo, false});
    servo.servo.substep.substep_compliance = full.substep.substep_compliance;
    out.push_back({"+ sub-step compliance", servo, false});
    servo.servo.substep.eliminate_welds = full.substep.eliminate_welds;
    out.push_back({"+ weld elimination", servo, false});
    servo.servo.newton_unknowns = full.newton_unknowns;
    servo.servo.conjugate = full.conjugate;
    out.push_back({"+ Newton", servo, false});
    out.push_back({"+ contact-frame prediction", servo});
    servo.servo.substep.extrapolate_frames = full.substep.extrapolate_frames;
    out.push_back({"+ contact-frame extrapolation", servo});
  }
  servo.servo = full;
  out.push_back({ablation ? "+ force cross-fade" : "servo", servo});
  if (ablation) out.push_back({"hindsight", hindsight});
  return out;
}

std::unique_ptr<Simulation> open(const CommandContext& context, const HapticBenchOptions& options, double step_s) {
  SimulationResult loaded = load_simulation(options.scene, context.registry, options.threads, step_s);
  context.err << loaded.diagnostics.format();
  return std::move(loaded.simulation);
}

/// Each nth.
std::vector<RecordedStep> every(std::size_t n, const std::vector<RecordedStep>& steps) {
  std::vector<RecordedStep> out;
  for (std::size_t k = n; k <= steps.size(); k += n) out.push_back(steps[k - 1]);
  return out;
}

void measure(const CommandContext& context, const HapticBenchOptions& options, Simulation& simulation) {
  const Latency latency = read_latency(options.latency);
  const Motion motion = load_motion(find_motion(simulation, options.motion));
  check_start(simulation, motion);
  const double duration = options.duration > 0 ? options.duration : motion.duration();
  fmt::print(context.out, "{}, {}: {:.2f} s\n", options.scene.string(), options.motion, duration);
  const ForceTrace reference = reference_forces(simulation, motion, duration);
  simulation.reset();
  fmt::print(context.out, "  {:<6}{:<18}{:<7}{:>9}{:>9}{:>9}{:>11}{:>9}\n", "Hz", "rendering", "hand", "peak mN",
             "rms %", "worst %", "onset ms", "jump %");
  for (const double rate : options.rates) {
    const double step_s = options.fine ? 1e-3 : 1 / rate;
    auto engine = open(context, options, step_s);
    if (!engine) throw InputError(fmt::format("it does not open with a step of {:.3g} ms", 1e3 * step_s));
    engine->set_collision_horizon(Publisher::collision_horizon_steps * step_s);
    const auto record = [&](double prediction_horizon_s) {
      engine->reset();
      auto steps = record_steps(*engine, motion, duration, prediction_horizon_s);
      if (options.fine) steps = every(std::size_t(std::lround(1e3 / rate)), steps);
      return steps;
    };
    const auto predicted = record(latency.at(1 / rate));
    const auto plain = record(-1);
    engine.reset();
    for (Variant& v : variants(options.ablation)) {
      const auto& steps = v.predicted ? predicted : plain;
      v.settings.latency_s = latency.at(1 / rate);
      v.settings.jitter = options.jitter;
      const ForceTrace rendered = replay(steps, motion, duration, v.settings);
      if (!options.traces.empty())
        write_traces(options.traces / fmt::format("{:.0f}_{}.csv", rate, v.name), reference, rendered);
      for (std::size_t hand = 0; hand < 2; ++hand) {
        const TruthOfHand t = compare(reference.force[hand], rendered.force[hand]);
        if (!t.counts()) continue;
        fmt::print(context.out, "  {:<6.0f}{:<18}{:<7}{:>9.1f}{:>9.2f}{:>9.1f}{:>11.0f}{:>9.1f}\n", rate, v.name,
                   hand ? "right" : "left", 1e3 * t.peak_N, 100 * t.rms, 100 * t.worst, 1e3 * t.onset_s,
                   100 * rendered.jump[hand] / t.peak_N);
      }
    }
    context.out.flush();
  }
}

}  // namespace

int cmd_bench_haptics(const CommandContext& context, const HapticBenchOptions& options) {
  const auto simulation = open(context, options, 1e-3);
  if (!simulation) return 2;
  try {
    measure(context, options, *simulation);
  } catch (const InputError& e) {
    context.err << options.scene.string() << ": error: " << e.what() << '\n';
    return 2;
  }
  return 0;
}

}  // namespace insula
