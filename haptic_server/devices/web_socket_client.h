// SPDX-License-Identifier: GPL-3.0-or-later
// A WebSocket client for one thread, in which nothing waits longer than it is told to.
#pragma once
#include <chrono>
#include <memory>
#include <string>
#include <string_view>

namespace insula {

class WebSocketClient {
 public:
  WebSocketClient();
  ~WebSocketClient();

  /// "ws://host:port/path". False, with error(), when there is no connection in time or the URL is none.
  bool connect(const std::string& url, std::chrono::milliseconds patience);
  bool connected() const;
  /// Both close the connection when they fail. `text` stays as it is until the next receive.
  bool send(const std::string& text, std::chrono::milliseconds patience);
  bool receive(std::string_view& text, std::chrono::milliseconds patience);
  void close();
  const std::string& error() const { return error_; }

 private:
  struct Connection;
  std::unique_ptr<Connection> connection_;
  std::string error_;
};

}  // namespace insula
