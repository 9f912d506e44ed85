// SPDX-License-Identifier: GPL-3.0-or-later
// HTTP and WebSocket clients for the tests, which call from any address of the loopback network.
#pragma once
#include <boost/asio/connect.hpp>
#include <boost/asio/ip/tcp.hpp>
#include <boost/asio/ssl/stream.hpp>
#include <boost/beast/core.hpp>
#include <boost/beast/http.hpp>
#include <boost/beast/websocket.hpp>
#include <string>
#include <utility>
#include <vector>

#include "core/bus/codec.h"
#include "viewer/gateway/framing.h"

namespace insula::gateway::pages {

namespace asio = boost::asio;
namespace beast = boost::beast;
namespace http = beast::http;
using tcp = asio::ip::tcp;
using Response = http::response<http::string_body>;
using Fields = std::vector<std::pair<std::string, std::string>>;

/// from: 127.0.0.1, or another one that stands for another machine.
inline void connect(tcp::socket& socket, const std::string& from, std::uint16_t port) {
  socket.open(tcp::v4());
  socket.bind({asio::ip::make_address(from), 0});
  socket.connect({asio::ip::make_address("127.0.0.1"), port});
  timeval limit{20, 0};  // a lost answer fails the test instead of hanging it
  ::setsockopt(socket.native_handle(), SOL_SOCKET, SO_RCVTIMEO, &limit, sizeof limit);
}

struct Request {
  http::verb verb = http::verb::get;
  std::string target = "/";
  Fields fields = {};
  std::string body = {};
};

template <class Stream>
Response exchange(Stream& stream, const std::string& host, const Request& asked) {
  http::request<http::string_body> request{asked.verb, asked.target, 11, asked.body};
  request.set(http::field::host, host);
  for (const auto& [field, value] : asked.fields) request.set(field, value);
  request.prepare_payload();
  http::write(stream, request);
  beast::flat_buffer buffer;
  http::response_parser<http::string_body> parser;
  http::read(stream, buffer, parser);
  return parser.release();
}

inline Response ask(const std::string& from, std::uint16_t port, const Request& request) {
  asio::io_context io;
  tcp::socket socket(io);
  connect(socket, from, port);
  return exchange(socket, "127.0.0.1", request);
}

inline Response ask_by_tls(const std::string& from, std::uint16_t port, const Request& request) {
  asio::io_context io;
  asio::ssl::context context(asio::ssl::context::tls_client);
  asio::ssl::stream<tcp::socket> stream(io, context);
  connect(stream.next_layer(), from, port);
  stream.handshake(asio::ssl::stream_base::client);
  return exchange(stream, "127.0.0.1", request);
}

/// A page's WebSocket.
class Socket {
 public:
  Socket(const std::string& from, std::uint16_t port, const std::string& query, const std::string& cookie = {}) {
    connect(ws_.next_layer(), from, port);
    ws_.set_option(beast::websocket::stream_base::decorator([&](beast::websocket::request_type& request) {
      if (!cookie.empty()) request.set(http::field::cookie, cookie);
    }));
    ws_.handshake("127.0.0.1:" + std::to_string(port), "/ws" + query);
    ws_.binary(true);
  }
  template <class T>
  void send(std::string_view channel, const T& message) {
    std::vector<std::uint8_t> payload;
    encode(message, payload);
    send_bytes(channel, payload);
  }
  void send_text(std::string_view channel, std::string_view text) {
    send_bytes(channel, {reinterpret_cast<const std::uint8_t*>(text.data()), text.size()});
  }
  /// The next message of a channel, as text.
  std::string receive(std::string_view channel) {
    for (;;) {
      beast::flat_buffer in;
      ws_.read(in);
      const auto parts = unframe(Bytes(static_cast<const std::uint8_t*>(in.cdata().data()), in.size()));
      if (parts && parts->channel == channel)
        return {reinterpret_cast<const char*>(parts->payload.data()), parts->payload.size()};
    }
  }

 private:
  void send_bytes(std::string_view channel, Bytes payload) { ws_.write(asio::buffer(*frame(channel, payload))); }

  asio::io_context io_;
  beast::websocket::stream<tcp::socket> ws_{io_};
};

}  // namespace insula::gateway::pages
