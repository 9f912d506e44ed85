// SPDX-License-Identifier: GPL-3.0-or-later
// The WebSocket side of one page.
#include "viewer/gateway/ws_client.h"

#include <fmt/format.h>

#include <atomic>
#include <utility>

#include "core/base/text.h"
#include "core/bus/channels.h"

namespace asio = boost::asio;
namespace websocket = boost::beast::websocket;

namespace insula::gateway {
namespace {

constexpr std::size_t max_from_page = 64 * 1024;
// Less than the kernel would take: what waits there is old by the time a slow client reads it.
constexpr int socket_send_buffer = 128 * 1024;
// A browser answers no ping while its page is held up, for instance by the first picture on a slow machine.
constexpr std::chrono::seconds longest_silence{120};

/// Of pages, in the record of commands.
std::uint64_t next_number() {
  static std::atomic<std::uint64_t> last{0};
  return ++last;
}

}  // namespace

WsClient::WsClient(PageStream&& stream, Hub& hub, Audit& audit, Visitor visitor)
    : ws_(std::move(stream)), hub_(hub), audit_(audit), visitor_(std::move(visitor)) {
  visitor_.page = next_number();
}

void WsClient::start(const http::request<http::string_body>& request) {
  beast::error_code ignored;
  auto& socket = beast::get_lowest_layer(ws_).socket();
  socket.set_option(asio::ip::tcp::no_delay(true), ignored);
  socket.set_option(asio::socket_base::send_buffer_size(socket_send_buffer), ignored);
  beast::get_lowest_layer(ws_).expires_never();  // the WebSocket has timeouts of its own
  websocket::stream_base::timeout timeouts = websocket::stream_base::timeout::suggested(beast::role_type::server);
  timeouts.idle_timeout = longest_silence;
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
  record(take(Bytes(static_cast<const std::uint8_t*>(data.data()), data.size())));
  in_.consume(in_.size());
  read();
}

Hub::Taken WsClient::take(Bytes message) {
  const auto now = RateLimit::Clock::now();
  const auto parts = unframe(message);
  const bool pose = parts && parts->channel == channel::hand_input;
  if (ws_.got_binary() && messages_.take(now) && (pose || actions_.take(now)))
    return hub_.from_page(message, visitor_, this);
  hub_.refuse_from_page();
  return {false, parts ? std::string(shown(parts->channel)) : std::string(), ws_.got_binary() ? "too many" : "text"};
}

/// A line for each command; one for all poses of the hands, and one for each stroke; few for refusals, so that they do
/// not fill the record.
void WsClient::record(const Hub::Taken& taken) {
  if (taken.accepted && taken.many && std::exchange(last_of_many_, taken.what) == taken.what) return;
  if (!taken.accepted && !refusals_.take(RateLimit::Clock::now())) {
    ++unrecorded_;
    return;
  }
  std::string why(taken.accepted ? std::string_view() : taken.why);
  if (!taken.accepted && unrecorded_ > 0) why += fmt::format(" (and {} more refusals)", std::exchange(unrecorded_, 0));
  audit_.write({visitor_.address, std::string(name_of(visitor_.role)), visitor_.page, taken.what, taken.accepted, why,
                visitor_.who});
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
