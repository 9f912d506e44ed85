// SPDX-License-Identifier: GPL-3.0-or-later
// One HTTP connection: the pages, the scene bundle, recorded sessions, what the start page asks for, /healthz, and the
// upgrade to a WebSocket at /ws.
#pragma once
#include <boost/beast/core.hpp>
#include <boost/beast/http.hpp>
#include <filesystem>
#include <memory>
#include <optional>

#include "viewer/gateway/access.h"
#include "viewer/gateway/hub.h"
#include "viewer/gateway/sessions.h"
#include "viewer/gateway/training_api.h"

namespace insula::gateway {

namespace beast = boost::beast;
namespace http = beast::http;

/// The built page.
struct PageFolder {
  std::filesystem::path folder;  ///< empty: it is not built
  bool start = false;            ///< "/" is the start page, else that of the exercise
};

class HttpSession : public std::enable_shared_from_this<HttpSession> {
 public:
  HttpSession(boost::asio::ip::tcp::socket&& socket, Hub& hub, const AllowedHosts& hosts, const PageFolder& page,
              const Sessions& sessions, TrainingApi& training);
  void start() { read(); }

 private:
  using Request = http::request<http::string_body>;
  void read();
  void on_read(beast::error_code error);
  bool refuse_foreign(const Request& request);
  void upgrade(const Request& request);
  void answer(const Request& request);
  void answer_training(const Request& request, const std::vector<std::string>& parts);
  void answer_session(const Request& request, const std::vector<std::string>& parts);
  bool from_this_machine() const;
  void send_text(const Request& request, http::status status, std::string_view type, std::string body);
  void send_file(const Request& request, const std::filesystem::path& file, std::string_view caching,
                 bool packed = false);
  /// A part of a file, where the request asks for one; otherwise all of it.
  void send_recording(const Request& request, const std::filesystem::path& file);
  template <class Response>
  void send(Response&& response);
  void close();

  beast::tcp_stream stream_;
  Hub& hub_;
  const AllowedHosts& hosts_;
  const PageFolder& page_;
  const Sessions& sessions_;
  TrainingApi& training_;
  beast::flat_buffer in_;
  std::optional<http::request_parser<http::string_body>> parser_;
};

}  // namespace insula::gateway
