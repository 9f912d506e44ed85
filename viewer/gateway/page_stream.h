// SPDX-License-Identifier: GPL-3.0-or-later
// The stream to one page: TCP, or TLS over it.
#pragma once
#include <boost/asio/async_result.hpp>
#include <boost/asio/ip/tcp.hpp>
#include <boost/asio/ssl/context.hpp>
#include <boost/beast/core/tcp_stream.hpp>
#include <boost/beast/ssl/ssl_stream.hpp>
#include <boost/beast/websocket.hpp>
#include <memory>
#include <string>
#include <utility>

namespace insula::gateway {

class PageStream {
 public:
  using next_layer_type = boost::beast::tcp_stream;
  using executor_type = next_layer_type::executor_type;
  using Error = boost::beast::error_code;

  /// tls: null for plain TCP; must outlive the stream.
  PageStream(boost::asio::ip::tcp::socket&& socket, boost::asio::ssl::context* tls) {
    if (tls) tls_ = std::make_unique<Tls>(std::move(socket), *tls);
    else tcp_ = std::make_unique<next_layer_type>(std::move(socket));
  }

  bool encrypted() const { return tls_ != nullptr; }
  next_layer_type& next_layer() { return tls_ ? tls_->next_layer() : *tcp_; }
  const next_layer_type& next_layer() const { return tls_ ? std::as_const(*tls_).next_layer() : *tcp_; }
  executor_type get_executor() { return next_layer().get_executor(); }

  /// Only when encrypted.
  template <class Handler>
  void async_handshake(Handler&& handler) {
    tls_->async_handshake(boost::asio::ssl::stream_base::server, std::forward<Handler>(handler));
  }

  /// Only when encrypted. host: whose certificate is wanted.
  template <class Handler>
  void async_handshake_as_client(const std::string& host, Handler&& handler) {
    SSL_set_tlsext_host_name(tls_->native_handle(), host.c_str());
    tls_->async_handshake(boost::asio::ssl::stream_base::client, std::forward<Handler>(handler));
  }

  template <class Buffers, class Token>
  auto async_read_some(const Buffers& buffers, Token&& token) {
    return boost::asio::async_initiate<Token, void(Error, std::size_t)>(
        [this](auto handler, const Buffers& to) {
          if (tls_) tls_->async_read_some(to, std::move(handler));
          else tcp_->async_read_some(to, std::move(handler));
        },
        token, buffers);
  }

  template <class Buffers, class Token>
  auto async_write_some(const Buffers& buffers, Token&& token) {
    return boost::asio::async_initiate<Token, void(Error, std::size_t)>(
        [this](auto handler, const Buffers& from) {
          if (tls_) tls_->async_write_some(from, std::move(handler));
          else tcp_->async_write_some(from, std::move(handler));
        },
        token, buffers);
  }

  /// WebSockets say themselves that they end, so that TLS need not.
  template <class Handler>
  friend void async_teardown(boost::beast::role_type role, PageStream& stream, Handler&& handler) {
    using boost::beast::websocket::async_teardown;
    async_teardown(role, stream.next_layer(), std::forward<Handler>(handler));
  }

 private:
  using Tls = boost::beast::ssl_stream<next_layer_type>;
  std::unique_ptr<next_layer_type> tcp_;
  std::unique_ptr<Tls> tls_;
};

}  // namespace insula::gateway
