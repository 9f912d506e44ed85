// SPDX-License-Identifier: GPL-3.0-or-later
// The engine process: signals and bus around run_live.
#include <signal.h>

#include <atomic>
#include <ostream>
#include <thread>

#include "core/base/signal_pipe.h"
#include "core/bus/bus.h"
#include "engine/live_engine.h"
#include "engine/run.h"

namespace insula {

int cmd_engine(const CommandContext& context, const EngineOptions& o) {
  const LiveOptions options{o.scene, o.motion, o.bundle_root, o.duration, o.unthrottled, o.threads, o.seed, o.keep_bundle};
  const SignalPipe ends{SIGINT, SIGTERM, SIGHUP};
  signal(SIGPIPE, SIG_IGN);

  const auto bus = make_bus();
  if (!bus->good()) {
    context.err << "error: " << bus->error() << '\n';
    return 1;
  }
  std::atomic<bool> stop{false}, over{false};
  std::thread waiter([&] {
    while (!over)
      if (ends.wait(100) != 0) stop = true;
  });
  int status = 1;
  try {
    status = run_live(options, context.registry, *bus, stop);
  } catch (const std::exception& e) {
    context.err << "error: " << e.what() << '\n';
  }
  over = true;
  waiter.join();
  return status;
}

}  // namespace insula
