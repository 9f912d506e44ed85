// SPDX-License-Identifier: GPL-3.0-or-later
// One request to another station's gateway.
#pragma once
#include <boost/asio/io_context.hpp>
#include <boost/beast/http/verb.hpp>
#include <functional>
#include <string>

#include "viewer/gateway/station_list.h"

namespace insula::gateway {

struct StationRequest {
  boost::beast::http::verb verb = boost::beast::http::verb::get;
  std::string target;
  std::string key;  ///< of the room; empty: none
};

struct StationAnswer {
  int status = 0;     ///< of HTTP; 0: there was none
  std::string body;   ///< at most 128 KB
  std::string error;  ///< why there was none
};

/// Asks, and calls `done` later, once, on the thread of `io`. Gives up after four seconds. By TLS, nothing is sent
/// before the certificate was found to be the listed one, or one that the system trusts for that name.
void ask_station(boost::asio::io_context& io, const StationAddress& station, const StationRequest& request,
                 std::function<void(StationAnswer)> done);

}  // namespace insula::gateway
