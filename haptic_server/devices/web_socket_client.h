// SPDX-License-Identifier: GPL-3.0-or-later
// A WebSocket client for one thread. All waits have a limit.
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

  /// "ws://host:port/path". False, with error(), if there is no connection in time or the URL is malformed.
  bool connect(const std::string& url, std::chrono::milliseconds patience);
  bool connected() const;
  /// Both close the connection if they fail. `text` is valid until the next receive.
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
