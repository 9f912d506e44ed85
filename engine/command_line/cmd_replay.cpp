// SPDX-License-Identifier: GPL-3.0-or-later
// Shows recorded sessions on a page. Sends a log of lcm-logger to the bus for viewers, without any message that could
// move a hand.
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <chrono>
#include <cstdlib>
#include <ostream>
#include <thread>

#include "core/base/input_error.h"
#include "core/base/signal_pipe.h"
#include "core/bus/codec.h"
#include "core/bus/event_log.h"
#include "engine/command_line/run.h"
#include "engine/command_line/tool_program.h"
#include "engine/session/session_format.h"
#include "engine/session/session_reader.h"

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

/// The gateway serves the page. It has a bus of its own, so that it neither hears nor disturbs a running session.
int serve_sessions(const CommandContext& context, const ReplayOptions& o) {
  std::vector<std::string> arguments{"--port", std::to_string(o.port)};
  for (const fs::path& file : o.files) {
    try {
      const SessionReader check(file);
    } catch (const InputError& e) {
      context.err << "error: " << e.what() << '\n';
      return 2;
    }
    arguments.insert(arguments.end(), {"--session", fs::absolute(file).string()});
  }
  ::setenv("LCM_DEFAULT_URL", "memq://", 1);
  return run_tool_program("gateway", arguments, "Build it first.", context.err);
}

int send_log(const CommandContext& context, const ReplayOptions& o) {
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
      EventLog log(o.files.front());
      const auto began = Clock::now();
      first_us = 0;
      for (LogEvent event; log.next(event);) {
        if (first_us == 0) first_us = event.time_us;
        if (!for_viewers(event.channel)) {
          ++left_out;
          continue;
        }
        if (event.channel == channel::scene_info) {
          find_bundle(o.files.front(), event.message);
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

}  // namespace

int cmd_replay(const CommandContext& context, const ReplayOptions& o) {
  const auto is_session = [](const fs::path& file) { return file.extension() == session::extension; };
  const auto sessions = std::count_if(o.files.begin(), o.files.end(), is_session);
  if (sessions == std::int64_t(o.files.size())) return serve_sessions(context, o);
  if (sessions == 0 && o.files.size() == 1) return send_log(context, o);
  context.err << "error: give recorded sessions (NAME.insula), or one log of lcm-logger\n";
  return 2;
}

}  // namespace insula
