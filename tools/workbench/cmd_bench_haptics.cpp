// SPDX-License-Identifier: GPL-3.0-or-later
// insula bench --haptics: the servo's force against the engine stepped at 1 kHz.
#include <fmt/ostream.h>
#include <array>

#include <algorithm>
#include <cmath>

#include "core/base/input_error.h"
#include "core/params/param.h"
#include "engine/live/live_engine.h"
#include "engine/live/motion_start.h"
#include "engine/live/publisher.h"
#include "tools/workbench/haptic_results.h"
#include "tools/workbench/haptic_truth.h"
#include "tools/workbench/random_probes.h"
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
  /// plain: as the step had them; predicted: contacts turned to where they are when the problem arrives; patched: with
  /// surface patches and reduced models too.
  enum Problems { plain, predicted, patched } problems = patched;
};

std::vector<Variant> variants(bool ablation) {
  ReplaySettings held, diagonal, servo, hindsight;
  held.rendering = Rendering::held;
  diagonal.rendering = Rendering::diagonal;
  hindsight.rendering = Rendering::hindsight;
  std::vector<Variant> out{{"held", held}};
  if (ablation) {
    out.push_back({"diagonal of W", diagonal, Variant::plain});
    out.push_back({"equation 7", servo, Variant::plain});
  }
  const ServoSettings full = ServoSettings::beyond_equation_7();
  if (ablation) {
    servo.servo.substep.incremental_slip = full.substep.incremental_slip;
    out.push_back({"+ incremental slip", servo, Variant::plain});
    servo.servo.substep.extrapolate_tissue = full.substep.extrapolate_tissue;
    out.push_back({"+ tissue extrapolation", servo, Variant::plain});
    servo.servo.substep.substep_compliance = full.substep.substep_compliance;
    out.push_back({"+ sub-step compliance", servo, Variant::plain});
    servo.servo.substep.eliminate_welds = full.substep.eliminate_welds;
    out.push_back({"+ weld elimination", servo, Variant::plain});
    servo.servo.newton_unknowns = full.newton_unknowns;
    servo.servo.conjugate = full.conjugate;
    out.push_back({"+ Newton", servo, Variant::plain});
    out.push_back({"+ contact-frame prediction", servo, Variant::predicted});
    servo.servo.substep.extrapolate_frames = full.substep.extrapolate_frames;
    out.push_back({"+ contact-frame extrapolation", servo, Variant::predicted});
    servo.servo.substep.find_contacts = full.substep.find_contacts;
    out.push_back({"+ contacts in each tick", servo});
    servo.servo.substep.predict_failure = full.substep.predict_failure;
    out.push_back({"+ failure prediction", servo});
    servo.servo.substep.reduced_dynamics = full.substep.reduced_dynamics;
    out.push_back({"+ reduced dynamics", servo});
  }
  servo.servo = full;
  out.push_back({ablation ? "+ force cross-fade" : "servo", servo});
  out.push_back({"hindsight", hindsight});
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

/// A scene that settles does so in every reset, so one that has not been stepped is left as it is.
void start_again(Simulation& simulation) {
  if (simulation.steps() > 0) simulation.reset();
}

/// The probe with the engine at a rate, rendered in each way.
void measure_at(const HapticBenchOptions& options, double rate, Simulation& engine, const Probe& probe,
                const ForceTrace& reference, double duration, std::vector<HapticResult>& results) {
  const Latency latency = read_latency(options.latency);
  const auto record = [&](double prediction_horizon_s, bool patches) {
    start_again(engine);
    auto steps = record_steps(engine, probe.motion, duration, prediction_horizon_s, patches);
    if (options.fine) steps = every(std::size_t(std::lround(1e3 / rate)), steps);
    return steps;
  };
  std::array<std::vector<RecordedStep>, 3> recorded;
  recorded[Variant::patched] = record(latency.at(1 / rate), true);
  if (options.ablation) {
    recorded[Variant::predicted] = record(latency.at(1 / rate), false);
    recorded[Variant::plain] = record(-1, false);
  }
  for (Variant& v : variants(options.ablation)) {
    const auto& steps = recorded[v.problems];
    v.settings.latency_s = latency.at(1 / rate);
    v.settings.jitter = options.jitter;
    const ForceTrace rendered = replay(steps, probe.motion, duration, v.settings);
    if (!options.traces.empty())
      write_traces(
          options.traces / fmt::format("{}{:.0f}_{}.csv", options.random > 0 ? probe.name + " " : "", rate, v.name),
          reference, rendered);
    for (int hand = 0; hand < 2; ++hand) {
      const auto h = std::size_t(hand);
      HapticResult r{rate, v.name, probe.name, hand, compare(reference.force[h], rendered.force[h]), rendered.jump[h],
                     0};
      for (const Vec3& f : rendered.force[h]) r.rendered_peak_N = std::max(r.rendered_peak_N, f.norm());
      if (r.truth.counts()) results.push_back(std::move(r));
    }
  }
}

std::vector<HapticResult> measure(const CommandContext& context, const HapticBenchOptions& options,
                                  Simulation& simulation, const std::vector<Probe>& probes) {
  std::vector<HapticResult> results;
  std::vector<ForceTrace> references;
  const auto duration = [&](const Probe& p) { return options.duration > 0 ? options.duration : p.motion.duration(); };
  for (const Probe& p : probes) {
    start_again(simulation);
    references.push_back(reference_forces(simulation, p.motion, duration(p)));
  }
  for (const double rate : options.rates) {
    const double step_s = options.fine ? 1e-3 : 1 / rate;
    auto engine = open(context, options, step_s);
    if (!engine) throw InputError(fmt::format("it does not open with a step of {:.3g} ms", 1e3 * step_s));
    engine->set_collision_horizon(Publisher::collision_horizon_steps * step_s);
    for (std::size_t k = 0; k < probes.size(); ++k)
      measure_at(options, rate, *engine, probes[k], references[k], duration(probes[k]), results);
  }
  return results;
}

void run(const CommandContext& context, const HapticBenchOptions& options, Simulation& simulation) {
  read_latency(options.latency);  // refused before the long work
  std::vector<Probe> probes;
  if (options.random > 0) probes = random_probes(simulation, options.random, options.seed);
  else {
    probes.push_back({options.motion, load_motion(find_motion(simulation, options.motion))});
    check_start(simulation, probes[0].motion);
  }
  const auto results = measure(context, options, simulation, probes);
  if (options.json) {
    context.out << haptic_json(results) << '\n';
    return;
  }
  if (options.random > 0) {
    fmt::print(context.out, "{}, {} random probes, seed {}\n", options.scene.string(), options.random, options.seed);
    return print_percentiles(context.out, results);
  }
  fmt::print(context.out, "{}, {}\n", options.scene.string(), options.motion);
  print_table(context.out, results);
}

}  // namespace

int cmd_bench_haptics(const CommandContext& context, const HapticBenchOptions& options) {
  const auto simulation = open(context, options, 1e-3);
  if (!simulation) return 2;
  try {
    run(context, options, *simulation);
  } catch (const InputError& e) {
    context.err << options.scene.string() << ": error: " << e.what() << '\n';
    return 2;
  }
  return 0;
}

}  // namespace insula
