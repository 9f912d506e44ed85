// SPDX-License-Identifier: GPL-3.0-or-later
// insula bench --recording: what it costs to record a session.
#include <fmt/ostream.h>
#include <unistd.h>

#include <chrono>
#include <nlohmann/json.hpp>

#include "core/base/input_error.h"
#include "engine/reports/report_writer.h"
#include "engine/session/session_recorder.h"
#include "tools/workbench/measured_run.h"
#include "tools/workbench/workbench.h"

namespace insula {
namespace {

namespace fs = std::filesystem;

struct RecordingCosts {
  std::vector<double> step_ms, recorder_ms;  ///< of each step: the simulation, and its recording
  double writer_ms = 0;                      ///< of the thread that compresses and writes, of all steps
  double bytes = 0;                          ///< of the file without what is written at the start
};

RecordingCosts measure(HeadlessRun& run, Simulation& simulation, SessionRecorder& recorder, int steps) {
  using Clock = std::chrono::steady_clock;
  RecordingCosts costs;
  for (int k = 0; k < steps; ++k) {
    const auto began = Clock::now();
    run.step();
    const auto stepped = Clock::now();
    recorder.step(simulation);
    costs.recorder_ms.push_back(std::chrono::duration<double, std::milli>(Clock::now() - stepped).count());
    costs.step_ms.push_back(std::chrono::duration<double, std::milli>(stepped - began).count());
  }
  recorder.close(simulation);
  costs.writer_ms = 1000 * recorder.writer_cpu_seconds();
  return costs;
}

}  // namespace

int cmd_bench_recording(const CommandContext& context, const BenchOptions& options) {
  const OpenedRun opened = open_for_measuring(context, options);
  if (!opened.simulation) return 2;
  Simulation& simulation = *opened.simulation;
  HeadlessRun run(simulation, opened.motion);
  warm_up(run, options, simulation.h());
  const fs::path file = fs::temp_directory_path() / fmt::format("insula_bench_{}.insula", ::getpid());
  RecordingCosts costs;
  try {
    SessionRecorder recorder(file, simulation, {options.scene, options.motion, "run"});
    const double before = double(fs::file_size(file));
    costs = measure(run, simulation, recorder, options.steps);
    costs.bytes = double(fs::file_size(file)) - before;
    if (!recorder.failure().empty()) throw InputError(recorder.failure());
    fs::remove(file);
  } catch (const std::exception& e) {
    std::error_code absent;
    fs::remove(file, absent);
    fmt::print(context.err, "error: {}\n", e.what());
    return 1;
  }
  const double step = mean(costs.step_ms), recording = mean(costs.recorder_ms);
  const double writer = costs.writer_ms / options.steps;
  const double ten_minutes_MB = 1e-6 * costs.bytes * 600 / (options.steps * simulation.h());
  if (options.json) {
    const nlohmann::json j = {{"scene", options.scene.string()},
                              {"steps", options.steps},
                              {"step_ms", {{"mean", step}}},
                              {"recorder_ms", {{"mean", recording}, {"max", largest(costs.recorder_ms)}}},
                              {"share_of_step_pct", 100 * recording / step},
                              {"writer_thread_ms", {{"mean", writer}}},
                              {"ten_minutes_MB", ten_minutes_MB}};
    context.out << j.dump(2) << '\n';
    return 0;
  }
  fmt::print(context.out,
             "{}  ({} steps)\n  step: {:.3f} ms mean\n"
             "  recording within the step: {:.4f} ms mean, {:.2f} % of it; {:.3f} ms at most, with a picture\n"
             "  the thread that compresses and writes: {:.3f} ms of a processor for each step\n"
             "  ten minutes of it: {:.1f} MB\n",
             options.scene.string(), options.steps, step, recording, 100 * recording / step, largest(costs.recorder_ms),
             writer, ten_minutes_MB);
  return 0;
}

}  // namespace insula
