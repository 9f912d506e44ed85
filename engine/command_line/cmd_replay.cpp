// SPDX-License-Identifier: GPL-3.0-or-later
// Sends a recorded session to the bus for viewers, without any message that could move a hand.
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <chrono>
#include <ostream>
#include <thread>

#include "core/base/input_error.h"
#include "core/base/signal_pipe.h"
#include "core/bus/codec.h"
#include "core/bus/event_log.h"
#include "engine/command_line/run.h"

namespace insula {
namespace {

namespace fs = std::filesystem;
using Clock = std::chrono::steady_clock;

/// Haptic problems, hands' inputs and commands are not sent, since a device or an engine may be on the bus.
bool for_viewers(std::string_view name) {
  constexpr std::array shown{channel::render_frame,  channel::scene_info, channel::sim_event,
                             channel::haptic_status, channel::metrics,    channel::device_state};
  return std::find(shown.begin(), shown.end(), name) != shown.end();
}

/// The bundles of a moved log are in the folder beside it.
void find_bundle(const fs::path& log, std::vector<std::uint8_t>& message) {
  auto info = decode<insula_lcm::scene_info_t>(message);
  std::error_code error;
  if (!info || fs::exists(fs::path(info->bundle) / "scene.json", error)) return;
  const fs::path beside = fs::absolute(log).parent_path() / fs::path(info->bundle).filename();
  if (!fs::exists(beside / "scene.json", error)) return;
  info->bundle = beside.string();
  encode(*info, message);
}

}  // namespace

int cmd_replay(const CommandContext& context, const ReplayOptions& o) {
  const auto bus = make_bus();
  if (!bus->good()) {
    context.err << "error: " << bus->error() << '\n';
    return 1;
  }
  const SignalPipe ends{SIGINT, SIGTERM, SIGHUP};
  std::int64_t sent = 0, left_out = 0, first_us = 0;
  bool bundle_missing = false;
  try {
    do {
      EventLog log(o.log);
      const auto began = Clock::now();
      first_us = 0;
      for (LogEvent event; log.next(event);) {
        if (first_us == 0) first_us = event.time_us;
        if (!for_viewers(event.channel)) {
          ++left_out;
          continue;
        }
        if (event.channel == channel::scene_info) {
          find_bundle(o.log, event.message);
          const auto info = decode<insula_lcm::scene_info_t>(event.message);
          if (info && !bundle_missing && info->state == "running" &&
              !fs::exists(fs::path(info->bundle) / "scene.json")) {
            context.err << fmt::format(
                "warning: the scene's bundle {} is gone: viewers have no geometry (record with --keep-bundle)\n",
                info->bundle);
            bundle_missing = true;
          }
        }
        const auto due = began + std::chrono::microseconds(std::int64_t(
                                     double(std::max<std::int64_t>(0, event.time_us - first_us)) / o.speed));
        while (Clock::now() < due)
          if (ends.wait(int(std::clamp<std::int64_t>(
                  std::chrono::duration_cast<std::chrono::milliseconds>(due - Clock::now()).count(), 0, 50))) != 0)
            return 0;
        bus->publish(event.channel, event.message);
        ++sent;
      }
    } while (o.loop);
  } catch (const InputError& e) {
    context.err << "error: " << e.what() << '\n';
    return 2;
  }
  context.out << fmt::format("{} messages sent, {} not for viewers\n", sent, left_out);
  return 0;
}

}  // namespace insula
