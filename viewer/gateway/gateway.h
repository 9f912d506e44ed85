// SPDX-License-Identifier: GPL-3.0-or-later
// The gateway: serves the viewer's page and the scene bundle over HTTP, and connects pages to the bus over WebSockets.
// It has no state of the simulation.
#pragma once
#include <cstdint>
#include <filesystem>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "core/bus/bus.h"
#include "viewer/gateway/access.h"
#include "viewer/gateway/secrets.h"
#include "viewer/gateway/station_list.h"
#include "viewer/gateway/studio.h"
#include "viewer/gateway/tls.h"
#include "viewer/gateway/training_api.h"

namespace insula::gateway {

struct Options {
  std::string listen = "127.0.0.1";                  ///< address to listen on; 0.0.0.0 admits other machines
  std::uint16_t port = 8080;                         ///< 0: any free one
  int more_ports = 20;                               ///< number of following ports that are tried if this one is busy
  std::vector<std::string> hosts;                    ///< names, besides its addresses, by which pages may address it
  std::filesystem::path page;                        ///< folder with index.html; empty: a note instead of the page
  bool start = false;                                ///< "/" is the start page, else that of the exercise
  TrainingApi::Files training;                       ///< what the start page shows
  TrainingApi::Asks asks;                            ///< of whoever started this program
  std::filesystem::path sessions;                    ///< folder of recorded sessions to offer; empty: none
  std::vector<std::filesystem::path> session_files;  ///< further ones
  Secrets secrets;                                   ///< admit pages of other machines to more than observing
  CertificateFiles tls;                              ///< empty: plain HTTP
  std::filesystem::path audit;                       ///< record of commands; empty: none
  std::string station;                               ///< its name in overviews; empty: the machine's
  std::vector<StationAddress> stations;              ///< of the room, for the overview
  std::filesystem::path kept_stations;               ///< JSON of those that pages add to it; empty: they add none
  std::filesystem::path kept_key;                    ///< file for a key that pages make or give; empty: they do not
  StudioPlaces studio;                               ///< of the page of the case builder
  bool discovery = true;          ///< announces the station where others reach it, and finds others for the overview
  IsHere is_here = same_machine;  ///< tells pages on this machine from others
};

class Gateway {
 public:
  /// The bus must outlive the gateway. Only the gateway may poll it. Throws InputError if the record of commands or the
  /// certificate cannot be used.
  Gateway(Bus& bus, Options options);
  ~Gateway();  ///< stops
  Gateway(const Gateway&) = delete;
  Gateway& operator=(const Gateway&) = delete;

  /// Opens the port and starts a bus thread and a network thread. Returns the error text; empty when started.
  std::string start();
  void stop();
  std::uint16_t port() const;  ///< the port in use
  std::string url() const;     ///< for a browser on this machine
  /// Why the station is not announced in the network; empty: it is, or need not be.
  const std::string& announcement_error() const;
  /// Of the page that shows the given session files, the first two side by side; empty: none were given.
  std::string sessions_query() const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace insula::gateway
