// SPDX-License-Identifier: GPL-3.0-or-later
// The gateway program: LCM on one side, browsers on the other.
#include <fmt/format.h>
#include <signal.h>

#include <CLI/CLI.hpp>
#include <cstdio>

#include "core/base/input_error.h"
#include "core/base/signal_pipe.h"
#include "core/bus/bus.h"
#include "viewer/gateway/gateway.h"
#include "viewer/gateway/static_files.h"

namespace {

namespace fs = std::filesystem;
using insula::gateway::Options;

/// Files that hold secrets, and where the gateway keeps its own.
struct Places {
  fs::path pins, key, own;
  fs::path stations;
  bool self_made = false;
};

void add_access_options(CLI::App& app, Options& options, Places& places) {
  app.add_option("--pins", places.pins, "JSON {pin, observer_pin}, readable by its owner alone: admits other machines");
  app.add_option("--room-key", places.key, "file with a key, readable by its owner alone: admits programs");
  auto* certificate = app.add_option("--certificate", options.tls.certificate, "PEM: serves by TLS");
  app.add_option("--key", options.tls.key, "PEM: private key of the certificate")->needs(certificate);
  app.add_flag("--tls", places.self_made, "serves by TLS with a certificate that is made here")->excludes(certificate);
  app.add_option("--station", options.station, "name of this station in overviews; default: the machine's");
  app.add_option("--stations", places.stations, "file of the room's stations, for the overview: NAME URL [SHA-256]");
  app.add_flag("!--no-mdns", options.discovery, "neither announces this station in the network nor looks for others");
  app.add_option("--own", places.own, "folder for the record of commands and the certificate made here");
}

/// Throws InputError.
void read_access(Options& options, const Places& places) {
  if (!places.pins.empty()) insula::gateway::read_pins(places.pins, options.secrets);
  if (!places.key.empty()) insula::gateway::read_key(places.key, options.secrets);
  if (!options.tls.certificate.empty() && options.tls.key.empty()) options.tls.key = options.tls.certificate;
  if (places.self_made && places.own.empty())
    throw insula::InputError("--tls needs --own, where its certificate is kept");
  if (!places.stations.empty()) options.stations = insula::gateway::read_stations(places.stations);
  if (!places.own.empty()) {
    std::error_code error;
    fs::create_directories(places.own, error);
    options.audit = places.own / "commands.log";
    options.kept_stations = places.own / "stations.json";
    if (places.key.empty()) options.kept_key = places.own / "room_key";
  }
  if (!options.kept_key.empty() && fs::exists(options.kept_key))
    insula::gateway::read_key(options.kept_key, options.secrets);
  if (places.self_made) options.tls = insula::gateway::self_made_certificate(places.own, options.hosts);
}

int serve(const Options& options, const std::string& address_of_bus) {
  const insula::SignalPipe ends{SIGINT, SIGTERM, SIGHUP};
  signal(SIGPIPE, SIG_IGN);
  const auto bus = insula::make_bus(address_of_bus);
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
  if (!options.tls.certificate.empty())
    fmt::print("SHA-256 of the certificate: {}\n", insula::gateway::fingerprint(options.tls.certificate));
  if (const std::string& error = gateway.announcement_error(); !error.empty())
    fmt::print("this station is not announced in the network: {}\n", error);
  fmt::print("serving {}\n", gateway.url());
  if (const std::string query = gateway.sessions_query(); !query.empty())
    fmt::print("recorded sessions at {}replay.html?{}\n", gateway.url(), query);
  if (!options.stations.empty() || !options.secrets.key.empty())
    fmt::print("the room is at {}room.html\n", gateway.url());
  std::fflush(stdout);
  ends.wait(-1);
  gateway.stop();
  return 0;
}

}  // namespace

int main(int argc, char** argv) {
  CLI::App app{"Insula's gateway: serves the viewer's page and joins it to the running simulation"};
  Options options;
  Places places;
  bool exact = false;
  std::string address_of_bus;
  app.add_option("--bus", address_of_bus, "address of the bus; memq:// is one of its own (default: LCM_DEFAULT_URL)");
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
  app.add_option("--studio", options.studio.data, "folder of the user's data: offers the page of the case builder");
  app.add_flag("--start", options.start, "begin with the start page");
  add_access_options(app, options, places);
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
  options.studio.programs = fs::read_symlink("/proc/self/exe").parent_path();
  if (exact) options.more_ports = 0;
  if (options.page.empty()) options.page = insula::gateway::find_page();

  try {
    read_access(options, places);
    return serve(options, address_of_bus);
  } catch (const insula::InputError& e) {
    fmt::print(stderr, "error: {}\n", e.what());
    return 2;
  }
}
