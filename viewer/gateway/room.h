// SPDX-License-Identifier: GPL-3.0-or-later
// An instructor's overview of the stations of a room. This gateway asks them, so that browsers need no rights at
// several stations and the stations admit no other site. Used on the network thread.
#pragma once
#include <boost/asio/io_context.hpp>
#include <boost/asio/steady_timer.hpp>
#include <functional>
#include <string>
#include <vector>

#include "viewer/gateway/station_client.h"

namespace insula::gateway {

class Room {
 public:
  static constexpr auto period = std::chrono::seconds(2);  ///< between two questions to a station
  /// key: is shown to the stations; empty: none.
  Room(boost::asio::io_context& io, std::vector<StationAddress> stations, std::string key);
  void start();

  /// [{url, name of the list, error: why it does not answer, station: what it says of itself (station.h), or null}]
  std::string json() const;
  /// JPEG; empty: there is none.
  const std::string& picture(std::size_t station) const;
  std::size_t size() const { return stations_.size(); }
  /// Calls `done` with the address of the station's page of the instructor. If the station asks for logins, the address
  /// has a ticket, which admits once.
  void open(std::size_t station, std::function<void(std::string url)> done);

 private:
  struct Entry {
    StationAddress address;
    std::string said;  ///< JSON; empty: nothing yet
    std::string error = "it was not asked yet", picture;
    std::uint64_t picture_number = 0;
    bool asking = false;
  };
  void ask_all();
  void ask(Entry& entry);
  void heard(Entry& entry, StationAnswer answer);
  void ask_picture(Entry& entry, std::uint64_t number);

  boost::asio::io_context& io_;
  boost::asio::steady_timer timer_;
  std::vector<Entry> stations_;
  std::string key_;
};

}  // namespace insula::gateway
