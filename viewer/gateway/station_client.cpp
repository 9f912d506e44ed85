// SPDX-License-Identifier: GPL-3.0-or-later
#include "viewer/gateway/station_client.h"

#include <boost/asio/steady_timer.hpp>
#include <boost/beast/core.hpp>
#include <boost/beast/http.hpp>
#include <memory>
#include <optional>

#include "viewer/gateway/page_stream.h"
#include "viewer/gateway/tls.h"

namespace insula::gateway {
namespace {

namespace asio = boost::asio;
namespace beast = boost::beast;
namespace http = beast::http;
using asio::ip::tcp;

constexpr auto patience = std::chrono::seconds(4);
constexpr std::uint64_t most_answer_bytes = 128 * 1024;

class Asking : public std::enable_shared_from_this<Asking> {
 public:
  Asking(asio::io_context& io, const StationAddress& station, const StationRequest& asked,
         std::function<void(StationAnswer)> done)
      : station_(station), done_(std::move(done)), resolver_(io), deadline_(io) {
    if (station.encrypted) tls_ = client_context(station.fingerprint, station.host);
    stream_.emplace(tcp::socket(io), tls_.get());
    request_ = {asked.verb, asked.target, 11};
    request_.set(http::field::host, station.host_and_port());
    if (!asked.key.empty()) request_.set(http::field::authorization, "Bearer " + asked.key);
    request_.prepare_payload();
    parser_.body_limit(most_answer_bytes);
  }

  void start() {
    // A name's search has no timeout of its own.
    deadline_.expires_after(patience);
    deadline_.async_wait([self = shared_from_this()](beast::error_code stopped) {
      if (stopped) return;
      self->resolver_.cancel();
      self->stream_->next_layer().close();
    });
    resolver_.async_resolve(station_.host, station_.port,
                            [self = shared_from_this()](beast::error_code error, const auto& found) {
                              if (error) return self->fail(error);
                              self->connect(found);
                            });
  }

 private:
  void connect(const tcp::resolver::results_type& found) {
    stream_->next_layer().async_connect(found, [self = shared_from_this()](beast::error_code error, const auto&) {
      if (error) return self->fail(error);
      if (!self->stream_->encrypted()) return self->write();
      self->stream_->async_handshake_as_client(self->station_.host, [self](beast::error_code refused) {
        if (refused) return self->fail(refused);
        self->write();
      });
    });
  }

  void write() {
    http::async_write(*stream_, request_, [self = shared_from_this()](beast::error_code error, std::size_t) {
      if (error) return self->fail(error);
      self->read();
    });
  }

  void read() {
    http::async_read(*stream_, in_, parser_, [self = shared_from_this()](beast::error_code error, std::size_t) {
      if (error) return self->fail(error);
      self->end({int(self->parser_.get().result_int()), self->parser_.get().body(), {}});
    });
  }

  void fail(beast::error_code error) { end({0, {}, error.message()}); }

  void end(StationAnswer answer) {
    deadline_.cancel();
    if (auto done = std::exchange(done_, nullptr)) done(std::move(answer));
  }

  StationAddress station_;
  std::function<void(StationAnswer)> done_;
  std::unique_ptr<asio::ssl::context> tls_;
  tcp::resolver resolver_;
  asio::steady_timer deadline_;
  std::optional<PageStream> stream_;
  http::request<http::empty_body> request_;
  http::response_parser<http::string_body> parser_;
  beast::flat_buffer in_;
};

}  // namespace

void ask_station(asio::io_context& io, const StationAddress& station, const StationRequest& request,
                 std::function<void(StationAnswer)> done) {
  std::make_shared<Asking>(io, station, request, std::move(done))->start();
}

}  // namespace insula::gateway
