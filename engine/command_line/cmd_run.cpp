// SPDX-License-Identifier: GPL-3.0-or-later
// insula run: runs a scene from start to end and reports the result.
#include <fmt/ostream.h>

#include <cmath>
#include <fstream>

#include "core/base/input_error.h"
#include "core/mechanics/shell_body.h"
#include "core/mechanics/soft_body.h"
#include "engine/command_line/run.h"
#include "engine/live/headless.h"
#include "engine/live/step_rate.h"
#include "engine/reports/report_writer.h"
#include "engine/session/session_format.h"
#include "engine/session/session_recorder.h"

namespace insula {
namespace {

void export_bodies(const Simulation& simulation, const std::filesystem::path& folder) {
  std::filesystem::create_directories(folder);
  for (const Body* b : simulation.bodies()) {
    const auto* body = dynamic_cast<const DeformableBody*>(b);
    if (!body) continue;
    std::vector<Vec3> nodes, moved;
    for (int i = 0; i < body->nodes(); ++i) {
      nodes.push_back(body->q().segment<3>(3 * i));
      moved.push_back(nodes.back() - body->rest_nodes()[std::size_t(i)]);
    }
    const auto file = folder / (body->id + ".vtu");
    if (const auto* soft = dynamic_cast<const SoftBody*>(body)) write_vtu(file, nodes, soft->rest().tets, moved);
    else if (const auto* shell = dynamic_cast<const ShellBody*>(body))
      write_vtu(file, nodes, shell->rest().triangles, moved);
  }
}

/// False, and a message, if the file cannot be made. No file is wanted: nothing happens.
bool begin_recording(const CommandContext& context, const RunOptions& options, const Simulation& simulation,
                     std::unique_ptr<SessionRecorder>& session) {
  if (options.record.empty()) return true;
  try {
    const SessionAbout about{options.scene, options.motion, "headless", session::parse_fields(options.fields)};
    session = std::make_unique<SessionRecorder>(options.record, simulation, about);
    return true;
  } catch (const InputError& e) {
    fmt::print(context.err, "error: {}\n", e.what());
    return false;
  }
}

bool is_whole(const CommandContext& context, const SessionRecorder& session) {
  const std::string why = session.failure();
  if (!why.empty()) fmt::print(context.err, "error: the recording has ended early: {}\n", why);
  return why.empty();
}

/// False, and a message, if the bands cannot be used for this scene.
bool read_bands(const CommandContext& context, const RunOptions& options, const Simulation& simulation,
                ReferenceBands& bands) {
  const std::filesystem::path file = options.bands.empty() ? bands_beside(options.scene) : options.bands;
  if (file.empty()) return true;
  try {
    bands = bands_for(file, options.band_group, simulation.scene().title());
    return true;
  } catch (const InputError& e) {
    fmt::print(context.err, "error: {}\n", e.what());
    return false;
  }
}

/// The events of a step, and its numbers at every fifth percent. shown: the percent said last.
void say_step(const CommandContext& context, const Simulation& simulation, int percent, int& shown) {
  for (const Event& e : simulation.events())
    fmt::print(context.out, "  {:7.2f} s  {} {} {}\n", e.time, e.kind, e.id, e.text);
  if (percent / 5 == shown / 5 && shown >= 0) return;
  shown = percent;
  fmt::print(context.out, "{:3d} %  {:7.2f} s  {} rows, {} contacts\n", percent, simulation.time(),
             simulation.report().rows, simulation.report().contacts.size());
  context.out.flush();
}

}  // namespace

int cmd_run(const CommandContext& context, const RunOptions& options) {
  const OpenedRun opened =
      open_run(context, options.scene, options.motion, false, options.threads, read_step_rate(options.rate).step_s());
  if (!opened.simulation) return 2;
  Simulation& simulation = *opened.simulation;
  if (options.seed != 0) simulation.draw_complications(options.seed);
  const Motion& motion = opened.motion;
  const double duration = options.duration > 0 ? options.duration : motion.empty() ? 10.0 : motion.duration() + 1.0;
  const auto steps = std::int64_t(std::ceil(duration / simulation.h() - 1e-9));

  HeadlessRun run(simulation, motion);
  RunRecorder recorder;
  RunSummary summary;
  std::unique_ptr<SessionRecorder> session;
  if (!read_bands(context, options, simulation, summary.bands)) return 2;
  if (!begin_recording(context, options, simulation, session)) return 1;
  int shown = -1;
  for (std::int64_t k = 0; k < steps; ++k) {
    run.step();
    if (session) session->step(simulation);
    const auto& haptics = run.haptics();
    recorder.record(simulation.report(), simulation.events(),
                    {haptics.hand(0).force.norm(), haptics.hand(1).force.norm()}, simulation.energy());
    summary.wall_seconds += simulation.report().step_ms / 1000;
    if (simulation.exercise()) summary.moments.observe(simulation.time(), *simulation.exercise());
    if (!options.quiet) say_step(context, simulation, int(100 * (k + 1) / steps), shown);
    if (!simulation.report().finite) break;
  }
  summary.take(simulation);
  summary.scene = options.scene.string();
  summary.motion = options.motion;
  summary.recording = options.record.string();
  summary.fresh_forces_per_s = run.haptics().fresh_forces_per_s();
  for (int h = 0; h < 2; ++h) summary.max_force_N[std::size_t(h)] = run.haptics().hand(h).max_force_N;
  if (session) {
    session->review(review_message(session->pass(), review_of(recorder, summary)));
    session->close(simulation);
  }
  try {
    if (!options.report.empty()) write_report(options.report, recorder, summary);
    if (!options.export_folder.empty()) export_bodies(simulation, options.export_folder);
  } catch (const std::exception& e) {
    fmt::print(context.err, "error: {}\n", e.what());
    return 1;
  }
  fmt::print(context.out, "{:.2f} s simulated in {:.2f} s (real_time_factor {:.2f}), state_hash {:016x}\n",
             simulation.time(), summary.wall_seconds, simulation.time() / std::max(1e-9, summary.wall_seconds),
             summary.state_hash);
  if (session && !is_whole(context, *session)) return 1;
  if (!recorder.finite()) {
    fmt::print(context.err, "error: the simulation left the range of numbers at {:.3f} s\n", simulation.time());
    return 1;
  }
  return 0;
}

}  // namespace insula
