// SPDX-License-Identifier: GPL-3.0-or-later
// One page on a WebSocket: an outbox with one write in flight, and a reader that passes messages to the hub.
#pragma once
#include <boost/beast/core.hpp>
#include <boost/beast/http.hpp>
#include <boost/beast/websocket.hpp>
#include <chrono>
#include <memory>

#include "viewer/gateway/access.h"
#include "viewer/gateway/audit.h"
#include "viewer/gateway/hub.h"
#include "viewer/gateway/page_stream.h"
#include "viewer/gateway/rate_limit.h"

namespace insula::gateway {

namespace beast = boost::beast;
namespace http = beast::http;

class WsClient final : public Client, public std::enable_shared_from_this<WsClient> {
 public:
  WsClient(PageStream&& stream, Hub& hub, Audit& audit, Visitor visitor);
  /// Answers the upgrade request and starts the exchange. The client exists until its connection ends.
  void start(const http::request<http::string_body>& request);

  void send(Topic topic, const Message& message) override;
  std::uint64_t dropped() const override { return outbox_.dropped(); }
  const Visitor& visitor() const override { return visitor_; }

 private:
  void read();
  void on_read(beast::error_code error, std::size_t bytes);
  void write();
  Hub::Taken take(Bytes message);
  void record(const Hub::Taken& taken);

  beast::websocket::stream<PageStream> ws_;
  Hub& hub_;
  Audit& audit_;
  Visitor visitor_;
  beast::flat_buffer in_;
  Outbox outbox_;
  Message in_flight_;
  bool open_ = false;
  // Two hands at 60 Hz and some commands, with room; then what persons do by hand; then lines that tell of refusals.
  RateLimit messages_{500, 500}, actions_{60, 120}, refusals_{2, 20};
  std::uint64_t unrecorded_ = 0;  // refusals since the last line
  std::string last_of_many_;
};

}  // namespace insula::gateway
