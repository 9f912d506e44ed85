// SPDX-License-Identifier: GPL-3.0-or-later
// insula devices
#include <signal.h>

#include <atomic>
#include <ostream>

#include "core/base/input_error.h"
#include "engine/command_line/commands.h"
#include "haptic_server/device_tool/device_tool.h"

namespace insula {
namespace {

std::atomic<bool> asked_to_stop{false};  // the only variable that a signal handler may change

void on_signal(int) { asked_to_stop.store(true); }

}  // namespace

int cmd_devices(const CommandContext& context, const DevicesOptions& given) {
  if (given.show.empty() && given.calibrate.empty() && given.test_force.empty()) return list_devices(context.out);
  // The force of a device fades out gently, whatever ends the program.
  struct sigaction action {};
  action.sa_handler = on_signal;
  for (const int s : {SIGINT, SIGTERM, SIGHUP}) sigaction(s, &action, nullptr);
  DeviceToolOptions options;
  options.out = &context.out;
  options.stop = &asked_to_stop;
  options.hand = given.hand == "left" ? 0 : 1;
  options.seconds = given.seconds;
  options.newtons = given.newtons;
  options.scale = given.scale;
  options.assume_yes = given.assume_yes;
  try {
    if (!given.calibrate.empty()) {
      options.device = given.calibrate;
      return calibrate_device(options);
    }
    if (!given.test_force.empty()) {
      options.device = given.test_force;
      return test_device_force(options);
    }
    options.device = given.show;
    return show_device(options);
  } catch (const InputError& e) {
    context.err << "error: " << e.what() << '\n';
    return 2;
  }
}

}  // namespace insula
