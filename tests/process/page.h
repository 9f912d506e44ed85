// SPDX-License-Identifier: GPL-3.0-or-later
// A page at a gateway, without drawing.
#pragma once
#include <atomic>
#include <boost/asio/connect.hpp>
#include <boost/asio/ip/tcp.hpp>
#include <boost/beast/core.hpp>
#include <boost/beast/websocket.hpp>
#include <functional>
#include <map>
#include <mutex>
#include <set>
#include <thread>
#include <utility>

#include "tests/process/play_session.h"
#include "viewer/gateway/framing.h"

namespace insula::testing {

/// A page that counts its frames in a thread of its own, and reconnects when the connection ends.
class Page {
 public:
  /// port: of the gateway on this machine, asked for at each connection.
  explicit Page(std::function<int()> port) : port_(std::move(port)), thread_([this] { run(); }) {}
  explicit Page(const PlaySession& session) : Page([&session] { return session.port(); }) {}
  ~Page() {
    stop_ = true;
    // Without further messages, a read would wait forever.
    if (const int s = socket_; s >= 0) ::shutdown(s, SHUT_RDWR);
    thread_.join();
  }
  Page(const Page&) = delete;
  Page& operator=(const Page&) = delete;

  std::set<std::int64_t> frames(std::int64_t session) const {
    std::lock_guard lock(mutex_);
    const auto found = frames_.find(session);
    return found == frames_.end() ? std::set<std::int64_t>{} : found->second;
  }
  int connections() const { return connections_; }

 private:
  void run() {
    while (!stop_) {
      try {
        connect_and_read();
      } catch (const std::exception&) {
        std::this_thread::sleep_for(50ms);
      }
    }
  }
  void connect_and_read() {
    boost::asio::io_context io;
    boost::beast::websocket::stream<boost::asio::ip::tcp::socket> ws(io);
    ws.next_layer().connect({boost::asio::ip::make_address("127.0.0.1"), std::uint16_t(port_())});
    timeval limit{1, 0};
    ::setsockopt(ws.next_layer().native_handle(), SOL_SOCKET, SO_RCVTIMEO, &limit, sizeof limit);
    ws.handshake("127.0.0.1", "/ws");
    struct Open {
      std::atomic<int>& socket;
      ~Open() { socket = -1; }
    } open{socket_};
    socket_ = ws.next_layer().native_handle();
    ++connections_;
    boost::beast::flat_buffer in;
    while (!stop_) {
      ws.read(in);
      const auto parts = gateway::unframe(Bytes(static_cast<const std::uint8_t*>(in.cdata().data()), in.size()));
      if (parts && parts->channel == channel::render_frame)
        if (const auto m = decode<insula_lcm::render_frame_t>(parts->payload)) {
          std::lock_guard lock(mutex_);
          frames_[m->session].insert(m->sequence);
        }
      in.consume(in.size());
    }
  }

  std::function<int()> port_;
  std::atomic<bool> stop_{false};
  std::atomic<int> connections_{0};
  std::atomic<int> socket_{-1};  ///< of the connection, while there is one
  mutable std::mutex mutex_;
  std::map<std::int64_t, std::set<std::int64_t>> frames_;
  std::thread thread_;
};

}  // namespace insula::testing
