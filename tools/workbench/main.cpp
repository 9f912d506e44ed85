// SPDX-License-Identifier: GPL-3.0-or-later
// The program `insula_workbench`: scenes checked and measured. `insula check` and `insula bench` hand over to it.
#include <CLI/CLI.hpp>

#include <functional>
#include <iostream>

#include "engine/command_line/load_plugins.h"
#include "tools/workbench/workbench.h"

namespace {

namespace fs = std::filesystem;
using Run = std::function<int(const insula::CommandContext&)>;

struct CheckArguments {
  std::vector<fs::path> files;
  bool settle = false;
};

void add_check(CLI::App& app, CheckArguments& arguments, Run& run) {
  auto* check = app.add_subcommand("check", "read scenes and report everything that is wrong with them");
  check->add_option("scene", arguments.files, "scene files")->required();
  check->add_flag("--settle", arguments.settle, "let scenes settle that do so first: slower, and tells what a step of them costs");
  check->callback([&] { run = [&](const auto& c) { return insula::cmd_check(c, arguments.files, arguments.settle); }; });
}

struct BenchArguments {
  insula::BenchOptions step;
  insula::ScalingOptions scaling;
  insula::HapticBenchOptions haptics;
  bool scale = false, measure_haptics = false;
};

void add_step_options(CLI::App* bench, BenchArguments& a) {
  auto* bench_scene = bench->add_option("scene", a.step.scene, "scene file");
  auto* scaling_flag = bench->add_flag("--scaling", a.scale, "without a scene: the stages against nodes, rows and strands, with their slopes; one thread unless --threads says otherwise")->excludes(bench_scene);
  bench->add_flag("--quick", a.scaling.quick, "with --scaling: small sizes only")->needs(scaling_flag);
  bench->add_option("--output", a.scaling.output, "with --scaling: folder for scaling.json and scaling.svg")->needs(scaling_flag);
  bench->add_option("--steps", a.step.steps, "steps to measure")->check(CLI::PositiveNumber)->capture_default_str();
  bench->add_option("--from", a.step.from, "simulated second at which measuring begins")->check(CLI::NonNegativeNumber);
  bench->add_option("--motion", a.step.motion, "what the hands do: a motion of the exercise, a CSV file, or none")->capture_default_str();
  bench->add_option("--threads", a.step.threads, "threads; 0 takes the machine's");
  bench->add_flag("--json", a.step.json, "print JSON");
  bench->add_flag("--solvers", a.step.solvers, "compare the solvers on the matrices and rows of the step at --from");
  bench->add_option("--rows", a.step.rows, "with --solvers: so many rows of each body at most; 0 takes all")->check(CLI::NonNegativeNumber);
  auto* record = bench->add_option("--record", a.step.record, "write the steps' constraint problems to this folder instead");
  bench->add_option("--every", a.step.every, "with --record: a problem of so many is written")->check(CLI::PositiveNumber)->needs(record);
  bench->add_option("--problems", a.step.problems, "solve this folder's constraint problems instead of stepping a scene")->excludes(bench_scene);
}

void add_haptic_options(CLI::App* bench, BenchArguments& a) {
  auto* haptics_flag = bench->add_flag("--haptics", a.measure_haptics, "how far the servo's force is from that of the engine stepped at 1 kHz, devices on the motion's path");
  bench->add_option("--rates", a.haptics.rates, "with --haptics: the engine's rates, Hz")->delimiter(',')->check(CLI::Range(20.0, 1000.0))->needs(haptics_flag);
  bench->add_option("--duration", a.haptics.duration, "with --haptics: simulated seconds; 0: the whole motion")->check(CLI::NonNegativeNumber)->needs(haptics_flag);
  bench->add_option("--latency", a.haptics.latency, "with --haptics: from poses to the problem's arrival, in steps (0.5) or as a time (3ms)")->capture_default_str()->needs(haptics_flag);
  bench->add_option("--jitter", a.haptics.jitter, "with --haptics: and so much later still at most, in steps")->check(CLI::Range(0.0, 3.0))->needs(haptics_flag);
  bench->add_flag("--fine", a.haptics.fine, "with --haptics: problems come at the rate, but from an engine that steps at 1 kHz: what is left is the servo's part of the error")->needs(haptics_flag);
  bench->add_flag("--ablation", a.haptics.ablation, "with --haptics: what goes beyond equation 7, one after the other")->needs(haptics_flag);
  bench->add_option("--traces", a.haptics.traces, "with --haptics: folder for the forces as CSV")->needs(haptics_flag);
}

/// The measurement that the options ask for.
Run chosen_bench(BenchArguments& a) {
  if (a.scale) {
    a.scaling.threads = a.step.threads > 0 ? a.step.threads : 1;
    a.scaling.json = a.step.json;
    return [&a](const auto& c) { return insula::cmd_bench_scaling(c, a.scaling); };
  }
  if (!a.step.problems.empty()) {
    return [&a](const auto& c) { return insula::cmd_bench_problems(c, a.step); };
  }
  if (a.step.scene.empty()) throw CLI::RequiredError("scene (or --scaling)");
  if (a.measure_haptics) {
    a.haptics.scene = a.step.scene;
    a.haptics.motion = a.step.motion;
    a.haptics.threads = a.step.threads;
    return [&a](const auto& c) { return insula::cmd_bench_haptics(c, a.haptics); };
  }
  if (!a.step.record.empty()) {
    return [&a](const auto& c) { return insula::cmd_record_problems(c, a.step); };
  }
  return [&a](const auto& c) { return a.step.solvers ? insula::cmd_bench_solvers(c, a.step) : insula::cmd_bench(c, a.step); };
}

void add_bench(CLI::App& app, BenchArguments& arguments, Run& run) {
  auto* bench = app.add_subcommand("bench", "where the time of a step goes");
  add_step_options(bench, arguments);
  add_haptic_options(bench, arguments);
  bench->callback([&] { run = chosen_bench(arguments); });
}

}  // namespace

int main(int argc, char** argv) {
  CLI::App app{"Insula: scenes checked and measured", "insula"};
  app.require_subcommand(1);
  std::vector<fs::path> plugin_paths;
  app.add_option("--plugin-path", plugin_paths, "folder of shared plugins, or one plugin (may be given more than once)")
      ->allow_extra_args(false);
  Run run;
  CheckArguments check;
  BenchArguments bench;
  add_check(app, check, run);
  add_bench(app, bench, run);
  try {
    app.parse(argc, argv);
  } catch (const CLI::ParseError& e) {
    return app.exit(e) == 0 ? 0 : 2;
  }
  try {
    insula::Registry registry;
    if (const int status = insula::load_plugins(registry, plugin_paths, std::cerr)) return status;
    return run({registry, std::cout, std::cerr});
  } catch (const std::exception& e) {
    std::cerr << "error: " << e.what() << '\n';
    return 1;
  }
}
