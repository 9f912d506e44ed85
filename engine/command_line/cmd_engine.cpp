// SPDX-License-Identifier: GPL-3.0-or-later
// The engine process: signals and bus around run_live.
#include <signal.h>

#include <atomic>
#include <chrono>
#include <ostream>
#include <thread>

#include "core/base/signal_pipe.h"
#include "core/bus/bus.h"
#include "engine/command_line/run.h"
#include "engine/live/live_engine.h"
#include "engine/live/step_rate.h"
#include "engine/session/session_format.h"

namespace insula {

int cmd_engine(const CommandContext& context, const EngineOptions& o) {
  LiveOptions options{o.scene,
                      o.motion,
                      o.bundle_root,
                      o.duration,
                      read_step_rate(o.rate),
                      o.unthrottled,
                      o.threads,
                      o.seed,
                      o.keep_bundle,
                      o.still,
                      o.notice,
                      o.report,
                      o.store,
                      o.record,
                      o.bands,
                      o.band_group,
                      session::parse_fields(o.fields),
                      session_mode(o.mode),
                      {}};
  const SignalPipe signals{SIGINT, SIGTERM, SIGHUP, SIGUSR1};
  signal(SIGPIPE, SIG_IGN);

  const auto bus = make_bus();
  if (!bus->good()) {
    context.err << "error: " << bus->error() << '\n';
    return 1;
  }
  std::atomic<bool> stop{false}, over{false}, go{false};
  std::thread waiter([&] {
    while (!over)
      if (const int signal = signals.wait(20); signal == SIGUSR1) go = true;
      else if (signal != 0) stop = true;
  });
  if (o.standby)
    options.take_over = [&] {
      context.out << standby_line << std::endl;
      while (!go && !stop) std::this_thread::sleep_for(std::chrono::milliseconds(5));
      return !stop.load();
    };
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
