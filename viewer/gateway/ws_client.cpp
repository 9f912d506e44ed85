// SPDX-License-Identifier: GPL-3.0-or-later
// The WebSocket side of one page.
#include "viewer/gateway/ws_client.h"

#include <algorithm>

namespace asio = boost::asio;
namespace websocket = boost::beast::websocket;

namespace insula::gateway {
namespace {

constexpr std::size_t max_from_page = 64 * 1024;
constexpr double max_messages_per_s = 500;  // two hands at 60 Hz and some commands, with room
// Less than the kernel would take: what waits there is old by the time a slow client reads it.
constexpr int socket_send_buffer = 128 * 1024;

}  // namespace

WsClient::WsClient(beast::tcp_stream&& stream, Hub& hub, Rights rights)
    : ws_(std::move(stream)), hub_(hub), rights_(rights) {}

void WsClient::start(const http::request<http::string_body>& request) {
  beast::error_code ignored;
  auto& socket = beast::get_lowest_layer(ws_).socket();
  socket.set_option(asio::ip::tcp::no_delay(true), ignored);
  socket.set_option(asio::socket_base::send_buffer_size(socket_send_buffer), ignored);
  beast::get_lowest_layer(ws_).expires_never();  // the WebSocket has timeouts of its own
  websocket::stream_base::timeout timeouts = websocket::stream_base::timeout::suggested(beast::role_type::server);
  timeouts.idle_timeout = std::chrono::seconds(30);
  timeouts.keep_alive_pings = true;
  ws_.set_option(timeouts);
  ws_.read_message_max(max_from_page);
  ws_.binary(true);
  ws_.auto_fragment(false);
  ws_.async_accept(request, [self = shared_from_this()](beast::error_code error) {
    if (error) return;
    self->open_ = true;
    self->hub_.join(self);
    self->read();
  });
}

void WsClient::read() { ws_.async_read(in_, beast::bind_front_handler(&WsClient::on_read, shared_from_this())); }

void WsClient::on_read(beast::error_code error, std::size_t) {
  if (error) {
    open_ = false;
    hub_.leave(this);
    return;
  }
  const auto data = in_.cdata();
  if (ws_.got_binary() && within_rate())
    hub_.from_page(Bytes(static_cast<const std::uint8_t*>(data.data()), data.size()), rights_, this);
  else hub_.refuse_from_page();
  in_.consume(in_.size());
  read();
}

bool WsClient::within_rate() {
  const auto now = std::chrono::steady_clock::now();
  const double seconds = std::chrono::duration<double>(now - allowance_at_).count();
  allowance_at_ = now;
  allowance_ = std::min(max_messages_per_s, allowance_ + seconds * max_messages_per_s);
  if (allowance_ < 1) return false;
  allowance_ -= 1;
  return true;
}

void WsClient::send(Topic topic, const Message& message) {
  if (!open_) return;
  outbox_.put(topic, message);
  if (!in_flight_) write();
}

void WsClient::write() {
  in_flight_ = outbox_.take();
  if (!in_flight_) return;
  ws_.async_write(asio::buffer(*in_flight_), [self = shared_from_this()](beast::error_code error, std::size_t) {
    self->in_flight_ = nullptr;
    if (error) {
      self->open_ = false;  // the reader notices too and leaves the hub
      return;
    }
    self->write();
  });
}

}  // namespace insula::gateway
