// SPDX-License-Identifier: GPL-3.0-or-later
// Boost.Beast's asynchronous operations, each run to its end or to its time limit.
#include "haptic_server/devices/web_socket_client.h"

#include <boost/asio/connect.hpp>
#include <boost/asio/io_context.hpp>
#include <boost/asio/ip/tcp.hpp>
#include <boost/beast/core.hpp>
#include <boost/beast/websocket.hpp>

#include <optional>

namespace insula {
namespace {

namespace asio = boost::asio;
namespace beast = boost::beast;
namespace websocket = beast::websocket;

constexpr std::size_t largest_message = 256u << 10;

bool split(const std::string& url, std::string& host, std::string& port, std::string& path) {
  constexpr std::string_view scheme = "ws://";
  if (!url.starts_with(scheme)) return false;
  const std::size_t slash = url.find('/', scheme.size());
  const std::string where = url.substr(scheme.size(), slash == std::string::npos ? slash : slash - scheme.size());
  path = slash == std::string::npos ? "/" : url.substr(slash);
  const std::size_t colon = where.rfind(':');
  host = where.substr(0, colon);
  port = colon == std::string::npos ? "80" : where.substr(colon + 1);
  return !host.empty() && !port.empty() && port.find_first_not_of("0123456789") == std::string::npos;
}

}  // namespace

struct WebSocketClient::Connection {
  asio::io_context context;
  websocket::stream<beast::tcp_stream> stream{context};
  beast::flat_buffer buffer;

  /// Runs `start(handler)` to its end. False if it fails or takes longer than the limit.
  template <class Start>
  bool run(std::chrono::milliseconds patience, std::string& error, Start start) {
    std::optional<beast::error_code> result;
    start([&result](beast::error_code e, auto&&...) { result = e; });
    context.restart();
    context.run_for(patience);
    if (!result) {
      error = "no answer in time";
      // The operation still has references into this frame, so it has to end first.
      beast::error_code ignored;
      stream.next_layer().socket().close(ignored);
      context.restart();
      context.run_for(std::chrono::seconds(1));
      return false;
    }
    if (*result) error = result->message();
    return !*result;
  }
};

WebSocketClient::WebSocketClient() = default;
WebSocketClient::~WebSocketClient() { close(); }

bool WebSocketClient::connected() const { return connection_ != nullptr; }

bool WebSocketClient::connect(const std::string& url, std::chrono::milliseconds patience) {
  close();
  std::string host, port, path;
  if (!split(url, host, port, path)) {
    error_ = "\"" + url + "\" is no address like ws://localhost:10001";
    return false;
  }
  auto connection = std::make_unique<Connection>();
  beast::error_code failed;
  asio::ip::tcp::resolver resolver(connection->context);
  const auto addresses = resolver.resolve(host, port, failed);
  if (failed) {
    error_ = failed.message();
    return false;
  }
  auto& tcp = connection->stream.next_layer();
  const bool there = connection->run(patience, error_, [&](auto done) { tcp.async_connect(addresses, done); });
  if (!there) return false;
  tcp.socket().set_option(asio::ip::tcp::no_delay(true), failed);
  tcp.expires_never();
  connection->stream.read_message_max(largest_message);
  if (!connection->run(patience, error_,
                       [&](auto done) { connection->stream.async_handshake(host + ":" + port, path, done); }))
    return false;
  connection_ = std::move(connection);
  return true;
}

bool WebSocketClient::send(const std::string& text, std::chrono::milliseconds patience) {
  if (!connection_) return false;
  connection_->stream.text(true);
  if (connection_->run(patience, error_, [&](auto done) { connection_->stream.async_write(asio::buffer(text), done); }))
    return true;
  connection_.reset();
  return false;
}

bool WebSocketClient::receive(std::string_view& text, std::chrono::milliseconds patience) {
  if (!connection_) return false;
  auto& buffer = connection_->buffer;
  buffer.consume(buffer.size());
  if (!connection_->run(patience, error_, [&](auto done) { connection_->stream.async_read(buffer, done); })) {
    connection_.reset();
    return false;
  }
  text = std::string_view(static_cast<const char*>(buffer.data().data()), buffer.size());
  return true;
}

void WebSocketClient::close() {
  if (!connection_) return;
  std::string ignored;
  connection_->run(std::chrono::milliseconds(200), ignored,
                   [&](auto done) { connection_->stream.async_close(websocket::close_code::normal, done); });
  connection_.reset();
}

}  // namespace insula
