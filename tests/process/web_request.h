// SPDX-License-Identifier: GPL-3.0-or-later
// An HTTP request that is sent unchanged, so that its fields can have any content.
#pragma once
#include <algorithm>
#include <boost/asio/buffer.hpp>
#include <boost/asio/ip/tcp.hpp>
#include <boost/asio/read.hpp>
#include <boost/asio/read_until.hpp>
#include <boost/asio/write.hpp>
#include <cstdlib>
#include <string>

namespace insula::testing {

struct WebAnswer {
  int status = 0;
  std::string text;  ///< head and body, as far as it came
};

inline WebAnswer web_request(const std::string& address, int port, const std::string& request) {
  boost::asio::io_context io;
  boost::asio::ip::tcp::socket socket(io);
  socket.connect({boost::asio::ip::make_address(address), std::uint16_t(port)});
  boost::asio::write(socket, boost::asio::buffer(request));
  boost::system::error_code error;
  WebAnswer answer;
  const std::size_t head = boost::asio::read_until(socket, boost::asio::dynamic_buffer(answer.text), "\r\n\r\n", error);
  if (head < 12) return answer;
  answer.status = std::atoi(answer.text.c_str() + 9);
  constexpr std::string_view length = "Content-Length: ";
  if (const std::size_t at = answer.text.find(length); at != std::string::npos && at < head) {
    const std::size_t whole = head + std::size_t(std::atoi(answer.text.c_str() + at + length.size()));
    const std::size_t missing = whole - std::min(whole, answer.text.size());
    boost::asio::read(socket, boost::asio::dynamic_buffer(answer.text), boost::asio::transfer_exactly(missing), error);
  }
  return answer;
}

inline std::string get_request(const std::string& target, const std::string& fields) {
  return "GET " + target + " HTTP/1.1\r\n" + fields + "\r\n";
}

/// A request for a WebSocket. Additional fields are given completely, each with its line end.
inline std::string upgrade_request(const std::string& fields, const std::string& target = "/ws") {
  return get_request(target,
                     "Connection: Upgrade\r\nUpgrade: websocket\r\nSec-WebSocket-Version: 13\r\n"
                     "Sec-WebSocket-Key: dGhlIHNhbXBsZSBub25jZQ==\r\n" +
                         fields);
}

}  // namespace insula::testing
