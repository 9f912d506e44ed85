// SPDX-License-Identifier: GPL-3.0-or-later
// One page on a WebSocket: an outbox with one write in flight, and a reader that passes messages to the hub.
#pragma once
#include <boost/beast/core.hpp>
#include <boost/beast/http.hpp>
#include <boost/beast/websocket.hpp>
#include <chrono>
#include <memory>

#include "viewer/gateway/access.h"
#include "viewer/gateway/hub.h"

namespace insula::gateway {

namespace beast = boost::beast;
namespace http = beast::http;

class WsClient final : public Client, public std::enable_shared_from_this<WsClient> {
 public:
  WsClient(beast::tcp_stream&& stream, Hub& hub, Rights rights);
  /// Answers the upgrade request and starts the exchange. The client exists until its connection ends.
  void start(const http::request<http::string_body>& request);

  void send(Topic topic, const Message& message) override;
  std::uint64_t dropped() const override { return outbox_.dropped(); }

 private:
  void read();
  void on_read(beast::error_code error, std::size_t bytes);
  void write();
  bool within_rate();

  beast::websocket::stream<beast::tcp_stream> ws_;
  Hub& hub_;
  Rights rights_;
  beast::flat_buffer in_;
  Outbox outbox_;
  Message in_flight_;
  bool open_ = false;
  double allowance_ = 0;  // number of messages that the page may still send now
  std::chrono::steady_clock::time_point allowance_at_{};
};

}  // namespace insula::gateway
