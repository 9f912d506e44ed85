// SPDX-License-Identifier: GPL-3.0-or-later
// insula bench --frames: the size of the viewer's frames, and the time that they take.
#include <fmt/ostream.h>

#include <chrono>
#include <nlohmann/json.hpp>

#include "core/bus/channels.h"
#include "core/bus/codec.h"
#include "core/bus/lcm_bus.h"
#include "engine/live/frame.h"
#include "engine/reports/report_writer.h"
#include "tools/workbench/measured_run.h"
#include "tools/workbench/workbench.h"

namespace insula {
namespace {

/// An address on which no session listens.
constexpr std::string_view bench_url = "udpm://239.255.76.67:7699?ttl=0";

/// Of each step: bytes of its frame; us of the step's report with its channels and drawables; us in which the frame is
/// filled, encoded and sent.
struct FrameCosts {
  std::vector<double> bytes, report_us, frame_us;
};

FrameCosts measure(HeadlessRun& run, Simulation& simulation, Bus& bus, int steps) {
  FrameCosts costs;
  insula_lcm::render_frame_t frame{};
  std::vector<std::uint8_t> scratch;
  for (int k = 0; k < steps; ++k) {
    run.step();
    costs.report_us.push_back(1e3 * simulation.report().stage_ms[stage_publish]);
    const auto began = std::chrono::steady_clock::now();
    fill_frame(simulation, frame);
    publish(bus, channel::render_frame, frame, scratch);
    costs.frame_us.push_back(
        std::chrono::duration<double, std::micro>(std::chrono::steady_clock::now() - began).count());
    costs.bytes.push_back(double(scratch.size()));
  }
  return costs;
}

}  // namespace

int cmd_bench_frames(const CommandContext& context, const BenchOptions& options) {
  const OpenedRun opened = open_for_measuring(context, options);
  if (!opened.simulation) return 2;
  Simulation& simulation = *opened.simulation;
  LcmBus bus(bench_url);
  HeadlessRun run(simulation, opened.motion);
  warm_up(run, options, simulation.h());
  const FrameCosts costs = measure(run, simulation, bus, options.steps);
  if (!bus.good()) {
    context.err << "error: " << bus.error() << '\n';
    return 1;
  }
  const double bytes = mean(costs.bytes);
  const double greatest = largest(costs.bytes);
  const double report = percentile(costs.report_us, 0.5), frame = percentile(costs.frame_us, 0.5);
  if (options.json) {
    const nlohmann::json j = {{"scene", options.scene.string()},
                              {"steps", options.steps},
                              {"frame_bytes", {{"mean", bytes}, {"max", greatest}}},
                              {"report_us", {{"p50", report}}},
                              {"frame_us", {{"p50", frame}}}};
    context.out << j.dump(2) << '\n';
    return 0;
  }
  fmt::print(context.out,
             "{}  ({} steps)\n  frame: {:.0f} bytes mean, {:.0f} max\n"
             "  report with channels and drawables: {:.1f} us median\n"
             "  frame filled, encoded and sent: {:.1f} us median\n",
             options.scene.string(), options.steps, bytes, greatest, report, frame);
  return 0;
}

}  // namespace insula
