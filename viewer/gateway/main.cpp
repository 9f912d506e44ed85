// SPDX-License-Identifier: GPL-3.0-or-later
// The gateway program: LCM on one side, browsers on the other.
#include <fmt/format.h>
#include <signal.h>

#include <CLI/CLI.hpp>
#include <cstdio>

#include "core/base/signal_pipe.h"
#include "core/bus/bus.h"
#include "viewer/gateway/gateway.h"
#include "viewer/gateway/static_files.h"

int main(int argc, char** argv) {
  CLI::App app{"Insula's gateway: serves the viewer's page and joins it to the running simulation"};
  insula::gateway::Options options;
  bool exact = false;
  app.add_option("--page", options.page, "folder with the built page (index.html)");
  app.add_option("--port", options.port, "port to listen on; following ones are tried when it is busy; 0: any")
      ->capture_default_str();
  app.add_flag("--exact-port", exact, "fail when the port is busy");
  app.add_option("--listen", options.listen, "address to listen on; 0.0.0.0 lets other machines watch")
      ->capture_default_str();
  app.add_option("--host", options.hosts,
                 "a name under which other machines' pages may ask for it; may be given several times");
  app.add_option("--sessions", options.sessions, "folder of recorded sessions that pages of this machine may see");
  app.add_option("--session", options.session_files, "a recorded session, in addition; may be given several times");
  app.add_option("--store", options.training.store, "training store: persons and their runs");
  app.add_option("--catalogue", options.training.catalogue, "JSON of the exercises that pages may choose from");
  app.add_option("--choice", options.training.choice, "JSON of the running exercise");
  app.add_option("--curricula", options.training.curricula, "JSON of the curricula that persons may follow");
  app.add_flag("--start", options.start, "begin with the start page");
  CLI11_PARSE(app, argc, argv);
  // The program that started this one reads it.
  options.asks.choose = [](const std::string& json) {
    fmt::print("choose {}\n", json);
    std::fflush(stdout);
  };
  options.asks.curricula = [] {
    fmt::print("curricula\n");
    std::fflush(stdout);
  };
  if (exact) options.more_ports = 0;
  if (options.page.empty()) options.page = insula::gateway::find_page();

  const insula::SignalPipe ends{SIGINT, SIGTERM, SIGHUP};
  signal(SIGPIPE, SIG_IGN);

  const auto bus = insula::make_bus();
  if (!bus->good()) {
    fmt::print(stderr, "{}\n", bus->error());
    return 1;
  }
  insula::gateway::Gateway gateway(*bus, options);
  if (const std::string error = gateway.start(); !error.empty()) {
    fmt::print(stderr, "{}\n", error);
    return 1;
  }
  if (!bus->good()) {  // subscribing is where a missing multicast route shows
    fmt::print(stderr, "{}\n", bus->error());
    return 1;
  }
  if (options.page.empty()) fmt::print("the viewer's page is not built; serving the data alone\n");
  fmt::print("serving {}\n", gateway.url());
  if (const std::string query = gateway.sessions_query(); !query.empty())
    fmt::print("recorded sessions at {}replay.html?{}\n", gateway.url(), query);
  std::fflush(stdout);
  ends.wait(-1);
  gateway.stop();
  return 0;
}
