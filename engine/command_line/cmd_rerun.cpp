// SPDX-License-Identifier: GPL-3.0-or-later
// insula rerun: the same inputs again.
#include <fmt/ostream.h>

#include <algorithm>
#include <array>

#include "core/base/input_error.h"
#include "engine/command_line/sessions.h"
#include "engine/reports/report_writer.h"
#include "engine/session/rerun.h"
#include "engine/session/session_format.h"

namespace insula {
namespace {

/// The report of the last pass through the exercise, as the live session would have written it at this moment.
class RerunReport {
 public:
  RerunReport(std::filesystem::path folder, SessionReader& session) : folder_(std::move(folder)) {
    if (folder_.empty()) return;
    forces_ = session.hand_forces();
    summary_.scene = session.about("scene");
    summary_.motion = session.about("motion");
    summary_.began = session.about("began");
  }
  void step(const Simulation& simulation) {
    ++number_;
    if (folder_.empty()) return;
    if (simulation.steps() == 1) {
      recorder_.clear();
      summary_.max_force_N = {};
      summary_.moments = {};
      summary_.wall_seconds = 0;
    }
    const std::array<double, 2> force = number_ < forces_.size() ? forces_[number_] : std::array<double, 2>{};
    recorder_.record(simulation.report(), simulation.events(), force, simulation.energy());
    for (std::size_t h = 0; h < 2; ++h) summary_.max_force_N[h] = std::max(summary_.max_force_N[h], force[h]);
    summary_.wall_seconds += simulation.report().step_ms / 1000;
    if (simulation.exercise()) summary_.moments.observe(simulation.time(), *simulation.exercise());
  }
  void write(const Simulation& simulation) {
    if (folder_.empty()) return;
    summary_.take(simulation);
    write_report(folder_, recorder_, summary_);
  }

 private:
  std::filesystem::path folder_;
  std::vector<std::array<double, 2>> forces_;  // by number of the step
  std::size_t number_ = 0;
  RunRecorder recorder_;
  RunSummary summary_;
};

}  // namespace

int cmd_rerun(const CommandContext& context, const RerunOptions& options) {
  RerunResult result;
  RerunSettings settings;
  settings.places = options.places;
  settings.threads = options.threads;
  try {
    SessionReader session(options.file);
    RerunReport report(options.report, session);
    std::int64_t steps = 0;
    const auto after = [&](const Simulation& simulation) {
      report.step(simulation);
      if (options.quiet || ++steps % 600 != 0) return;
      fmt::print(context.out, "{:8.2f} s\n", double(steps) * simulation.h());
      context.out.flush();
    };
    result = rerun(session, context.registry, settings, after, [&](const Simulation& s) { report.write(s); });
    for (const std::string& device : result.missing_devices)
      fmt::print(context.out,
                 "recorded on a device that is not here, rerun on the processor: the bits differ, values are compared "
                 "({})\n",
                 device);
    if (session.about("instruction_set") != session::instruction_set())
      fmt::print(context.out, "recorded with {} instructions, rerun with {}: the bits differ, values are compared\n",
                 session.about("instruction_set"), session::instruction_set());
  } catch (const InputError& e) {
    fmt::print(context.err, "error: {}\n", e.what());
    return 2;
  }
  if (!result.broken.empty()) fmt::print(context.err, "error: {}\n", result.broken);
  fmt::print(context.out, "{} steps, {} of {} compared states {}\n", result.steps, result.compared - result.different,
             result.compared, result.same_instructions ? "have the same bits" : "are within the tolerance");
  if (!result.same_instructions) fmt::print(context.out, "largest change {:.1e}\n", result.largest_change);
  if (result.different > 0)
    fmt::print(context.err, "error: the first other state is at {:.2f} s\n", result.first_different_s);
  return result.good() ? 0 : 1;
}

}  // namespace insula
