// SPDX-License-Identifier: GPL-3.0-or-later
// An instructor's overview of the stations of a room. This gateway asks them, so that browsers need no rights at
// several stations and the stations admit no other site. Used on the network thread.
#pragma once
#include <boost/asio/io_context.hpp>
#include <boost/asio/steady_timer.hpp>
#include <chrono>
#include <filesystem>
#include <functional>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "viewer/gateway/service_discovery.h"
#include "viewer/gateway/station_client.h"

namespace insula::gateway {

class Room {
 public:
  static constexpr auto period = std::chrono::seconds(2);         ///< between two questions to a station
  static constexpr auto nobody_looks = std::chrono::seconds(10);  ///< since the last look: then none is asked
  /// The stations of a room.
  struct Lists {
    std::vector<StationAddress> given;  ///< stay
    std::filesystem::path kept;         ///< JSON of those that pages add and remove; empty: none can be added
  };
  /// Throws InputError if a list is malformed. key: is shown to the listed stations; empty: none. discovery: finds
  /// others, which are shown but never asked; it must outlive the room; null: none are found.
  Room(boost::asio::io_context& io, Lists lists, std::string key, ServiceDiscovery* discovery);
  void start();
  /// Shown to the listed stations from now on.
  void set_key(std::string key) { key_ = std::move(key); }

  /// {stations: [{number, url, given, name, error, picture, station}], found: [{name, url}], search_error}. given: it
  /// stays. error: why it does not answer. station: what it says of itself (station.h), or null. found: in the network,
  /// not listed. search_error: why none are looked for; empty: they are. Stations are asked only while this is called
  /// again and again. The search in the network begins with the first call.
  std::string json();
  /// JPEG; empty: there is none.
  const std::string& picture(std::size_t station) const;
  /// Whether a station has that number. Numbers are given once.
  bool has(std::size_t station) const { return find(station) != nullptr; }
  /// Lists a station from now on. json: {name, url, fingerprint}. Why it is not; empty: it is.
  std::string add(const std::string& json);
  /// Takes an added one off the list. Why it is not; empty: it is.
  std::string remove(std::size_t station);
  /// Calls `done` with the address of the station's page of the instructor. If the station asks for logins, the address
  /// has a ticket, which admits once.
  void open(std::size_t station, std::function<void(std::string url)> done);

 private:
  struct Entry {
    StationAddress address;
    std::size_t number = 0;
    bool given = false;
    std::string said;  ///< JSON; empty: nothing yet
    std::string error = "it was not asked yet", picture;
    std::uint64_t picture_number = 0;
    bool asking = false;
  };
  using EntryPtr = std::shared_ptr<Entry>;
  EntryPtr find(std::size_t station) const;
  void list(StationAddress address, bool given);
  void read_kept();
  std::string keep() const;
  void ask_all();
  void ask_again();
  void ask(const EntryPtr& entry);
  void heard(const EntryPtr& entry, StationAnswer answer);
  void ask_picture(const EntryPtr& entry, std::uint64_t number);
  bool is_listed(const StationAddress& address) const;

  boost::asio::io_context& io_;
  boost::asio::steady_timer timer_;
  std::vector<EntryPtr> stations_;  ///< in the order in which they are shown
  std::size_t next_number_ = 0;
  std::chrono::steady_clock::time_point looked_{};
  std::filesystem::path kept_;
  std::string key_;
  ServiceDiscovery* discovery_;
};

}  // namespace insula::gateway
