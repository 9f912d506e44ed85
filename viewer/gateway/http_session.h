// SPDX-License-Identifier: GPL-3.0-or-later
// One HTTP connection: the pages, the scene bundle, recorded sessions, what the start page asks for, /healthz, and the
// upgrade to a WebSocket at /ws.
#pragma once
#include <boost/beast/core.hpp>
#include <boost/beast/http.hpp>
#include <filesystem>
#include <memory>
#include <optional>

#include "core/base/removed_at_end.h"
#include "viewer/gateway/page_stream.h"
#include "viewer/gateway/site.h"

namespace insula::gateway {

namespace beast = boost::beast;
namespace http = beast::http;

class HttpSession : public std::enable_shared_from_this<HttpSession> {
 public:
  /// tls: null for plain HTTP.
  HttpSession(boost::asio::ip::tcp::socket&& socket, boost::asio::ssl::context* tls, const Site& site);
  void start();

 private:
  using Request = http::request<http::string_body>;
  void read();
  void on_header(beast::error_code error);
  static bool is_upload(const http::request_header<>& request);
  void read_upload(const Request& head);
  void on_upload(beast::error_code error);
  void on_read(beast::error_code error);
  static bool same_site(const Request& request);
  bool refuse_foreign(const Request& request);
  bool refuse_strangers(const Request& request);
  Visitor visitor_of(const Request& request);
  void upgrade(const Request& request);
  void answer(const Request& request);
  void answer_login(const Request& request, bool out);
  void answer_room(const Request& request, const std::vector<std::string>& parts);
  void change_room(const Request& request);
  void answer_access(const Request& request);
  void take_picture(const Request& request);
  void give_ticket(const Request& request);
  void answer_training(const Request& request, const std::vector<std::string>& parts);
  void answer_studio(const Request& request, const std::vector<std::string>& parts);
  void answer_session(const Request& request, const std::vector<std::string>& parts);
  bool from_this_machine() const;
  /// {"error": why}; why: without quotes and backslashes.
  void send_error(const Request& request, http::status status, std::string_view why);
  void send_text(const Request& request, http::status status, std::string_view type, std::string body,
                 const std::vector<std::pair<http::field, std::string>>& fields = {});
  void send_file(const Request& request, const std::filesystem::path& file, std::string_view caching,
                 bool packed = false);
  /// A part of a file, where the request asks for one; otherwise all of it.
  void send_recording(const Request& request, const std::filesystem::path& file);
  template <class Response>
  void send(Response&& response);
  void close();

  boost::asio::ip::tcp::socket& socket() { return stream_.next_layer().socket(); }
  const boost::asio::ip::tcp::socket& socket() const { return stream_.next_layer().socket(); }

  PageStream stream_;
  Site site_;
  Visitor visitor_;  ///< of the present request
  beast::flat_buffer in_;
  std::optional<http::request_parser<http::string_body>> parser_;
  std::optional<http::request_parser<http::file_body>> upload_;
  std::unique_ptr<RemovedAtEnd> incoming_;  ///< the upload, until its project has it
};

}  // namespace insula::gateway
