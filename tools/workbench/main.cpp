// SPDX-License-Identifier: GPL-3.0-or-later
// The program `insula_workbench`: scenes checked and measured. `insula check` and `insula bench` hand over to it.
#include <CLI/CLI.hpp>

#include "engine/command_line/common_options.h"
#include "engine/command_line/run_command_line.h"
#include "tools/workbench/workbench.h"

namespace {

namespace fs = std::filesystem;
using insula::add_motion;
using insula::add_threads;
using insula::at_least;
using insula::Duration;
using insula::Frequency;
using insula::seconds;

/// What the options are read into, and the command that was chosen.
struct Options : insula::CommandLine {
  Options() : CommandLine("Insula: scenes checked and measured", "insula") {}

  std::vector<fs::path> files;
  bool settle = false, check_json = false, measure_scaling = false, measure_haptics = false;
  insula::BenchOptions bench;
  insula::ScalingOptions scaling;
  insula::HapticBenchOptions haptics;
};

void add_check(Options& c) {
  auto* check =
      c.app.add_subcommand("check", "read scenes and curricula and report everything that is wrong with them");
  insula::add_scene(*check, "file", c.files, "files of scenes and curricula, or names of scenes")->required();
  check->add_flag("--settle", c.settle,
                  "let scenes settle that do so first: slower, and tells what a step of them costs");
  check->add_flag("--json", c.check_json, "all problems as JSON, for editors; costs are left out");
  check->callback([&c] {
    c.chosen = [&](const auto& x) {
      return c.check_json ? insula::cmd_check_json(x, c.files) : insula::cmd_check(x, c.files, c.settle);
    };
  });
}

void add_haptic_bench(CLI::App& bench, Options& c) {
  auto& o = c.haptics;
  auto* flag = bench.add_flag(
      "--haptics", c.measure_haptics,
      "how far the servo's force is from that of the engine stepped at 1 kHz, devices on the motion's path");
  insula::add_quantities<Frequency>(
      bench, "--rates", o.rates,
      {.bare = "Hz", .min = "20 Hz", .max = "1 kHz", .doc = "with --haptics: the engine's rates"})
      ->needs(flag);
  insula::add_quantity<Duration>(bench, "--duration", o.duration,
                                 seconds("with --haptics: simulated time; 0: the whole motion"))
      ->needs(flag);
  bench
      .add_option("--latency", o.latency,
                  "with --haptics: from poses to the problem's arrival, in steps (0.5) or as a time (3ms)")
      ->capture_default_str()
      ->needs(flag);
  bench.add_option("--jitter", o.jitter, "with --haptics: and so much later still at most, in steps")
      ->check(CLI::Range(0.0, 3.0))
      ->needs(flag);
  bench
      .add_flag("--fine", o.fine,
                "with --haptics: problems come at the rate, but from an engine that steps at 1 kHz: what is left is "
                "the servo's "
                "part of the error")
      ->needs(flag);
  auto* ablation =
      bench.add_flag("--ablation", o.ablation, "with --haptics: what goes beyond equation 7, one after the other")
          ->needs(flag);
  auto* random = bench.add_option("--random", o.random,
                                  "with --haptics: so many taps, drags, presses and squeezes at random places that the "
                                  "tools reach, in place of a motion");
  random->check(CLI::Range(1, 10000))->needs(flag)->excludes(ablation);
  bench.add_option("--seed", o.seed, "with --random: of the places and movements")
      ->capture_default_str()
      ->needs(random);
  bench.add_option("--traces", o.traces, "with --haptics: folder for the forces as CSV")->needs(flag);
}

/// The benchmark that the options ask for.
void choose_bench(Options& c) {
  if (c.measure_scaling) {
    c.scaling.threads = c.bench.threads > 0 ? c.bench.threads : 1;
    c.scaling.json = c.bench.json;
    c.chosen = [&](const auto& x) { return insula::cmd_bench_scaling(x, c.scaling); };
  } else if (!c.bench.problems.empty()) {
    c.chosen = [&](const auto& x) { return insula::cmd_bench_problems(x, c.bench); };
  } else if (c.bench.scene.empty() && !(c.bench.solvers && c.bench.nodes > 0)) {
    throw CLI::RequiredError("scene (or --scaling)");
  } else if (c.measure_haptics) {
    c.haptics.scene = c.bench.scene;
    c.haptics.motion = c.bench.motion;
    c.haptics.threads = c.bench.threads;
    c.haptics.json = c.bench.json;
    c.chosen = [&](const auto& x) { return insula::cmd_bench_haptics(x, c.haptics); };
  } else if (!c.bench.record.empty()) {
    c.chosen = [&](const auto& x) { return insula::cmd_record_problems(x, c.bench); };
  } else if (c.bench.frames) {
    c.chosen = [&](const auto& x) { return insula::cmd_bench_frames(x, c.bench); };
  } else if (c.bench.recording) {
    c.chosen = [&](const auto& x) { return insula::cmd_bench_recording(x, c.bench); };
  } else if (c.bench.solvers) {
    c.chosen = [&](const auto& x) { return insula::cmd_bench_solvers(x, c.bench); };
  } else {
    c.chosen = [&](const auto& x) { return insula::cmd_bench(x, c.bench); };
  }
}

void add_bench(Options& c) {
  auto& o = c.bench;
  auto* command = c.app.add_subcommand("bench", "where the time of a step goes");
  auto* scene = insula::add_scene(*command, "scene", o.scene, "file or name of a scene");
  auto* scaling =
      command->add_flag("--scaling", c.measure_scaling,
                        "without a scene: the stages against nodes, rows and fibres, with their slopes; one thread "
                        "unless --threads says otherwise");
  scaling->excludes(scene);
  command->add_flag("--quick", c.scaling.quick, "with --scaling: small sizes only")->needs(scaling);
  command->add_option("--output", c.scaling.output, "with --scaling: folder for scaling.json and scaling.svg")
      ->needs(scaling);
  command->add_option("--steps", o.steps, "steps to measure")->check(at_least(1))->capture_default_str();
  insula::add_quantity<Duration>(*command, "--from", o.from, seconds("simulated time at which measuring begins"));
  add_motion(*command, o.motion);
  add_threads(*command, o.threads);
  command->add_flag("--json", o.json, "print JSON");
  command->add_flag("--frames", o.frames, "the size of the viewer's frames, and the time that they take");
  command->add_flag("--recording", o.recording, "the time that it takes to record the session, and its size");
  command->add_flag("--solvers", o.solvers, "compare the solvers on the matrices and rows of the step at --from");
  command->add_option("--rows", o.rows, "with --solvers: so many rows of each body at most; 0 takes all")
      ->check(at_least(0));
  command
      ->add_option("--nodes", o.nodes,
                   "with --solvers, without a scene: on a brick of about so many nodes, our own solvers alone")
      ->check(CLI::Range(27, 200000))
      ->excludes(scene);
  command->add_option("--blas", o.blas, "with --solvers: CHOLMOD also on this folder's libblas.so.3 and liblapack.so.3")
      ->check(CLI::ExistingDirectory);
  auto* record =
      command->add_option("--record", o.record, "write the steps' constraint problems to this folder instead");
  command->add_option("--every", o.every, "with --record: a problem of so many is written")
      ->check(at_least(1))
      ->needs(record);
  command->add_option("--problems", o.problems, "solve this folder's constraint problems instead of stepping a scene")
      ->excludes(scene);
  add_haptic_bench(*command, c);
  command->callback([&c] { choose_bench(c); });
}

}  // namespace

int main(int argc, char** argv) {
  Options options;
  add_check(options);
  add_bench(options);
  return insula::run_command_line(options, argc, argv);
}
