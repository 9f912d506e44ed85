// SPDX-License-Identifier: GPL-3.0-or-later
// HTTP requests and their answers.
#include "viewer/gateway/http_session.h"

#include <fmt/format.h>

#include <algorithm>
#include <boost/beast/websocket.hpp>
#include <fstream>
#include <type_traits>

#include "core/base/text.h"
#include "viewer/gateway/byte_range.h"
#include "viewer/gateway/static_files.h"
#include "viewer/gateway/ws_client.h"

namespace insula::gateway {
namespace {

constexpr auto request_timeout = std::chrono::seconds(30);
constexpr std::uint32_t header_limit = 16 * 1024;
/// A part that takes longer to read would delay pictures. A page asks again for the rest.
constexpr std::uint64_t most_part_bytes = 4 << 20;
constexpr std::string_view not_built =
    "<!doctype html><meta charset=utf-8><title>Insula</title><p>The viewer's page is not built. "
    "Run <code>npm ci &amp;&amp; npm run build</code> in <code>viewer/page</code>, then start again.</p>\n";

namespace fs = std::filesystem;

std::string_view view(beast::string_view s) { return {s.data(), s.size()}; }

/// A page of another site may open a WebSocket to this one: browsers send its origin, which must be ours. The port may
/// differ (the page's development server). Programs that are no browsers send no origin.
bool same_site(const http::request<http::string_body>& request) {
  const std::string_view origin = view(request[http::field::origin]);
  if (origin.empty()) return true;
  const std::size_t scheme = origin.find("://");
  if (scheme == std::string_view::npos) return false;
  const std::string name = host_name(origin.substr(scheme + 3));
  return !name.empty() && name == host_name(view(request[http::field::host]));
}

}  // namespace

HttpSession::HttpSession(boost::asio::ip::tcp::socket&& socket, Hub& hub, const AllowedHosts& hosts,
                         const PageFolder& page, const Sessions& sessions, TrainingApi& training)
    : stream_(std::move(socket)), hub_(hub), hosts_(hosts), page_(page), sessions_(sessions), training_(training) {}

void HttpSession::read() {
  parser_.emplace();
  parser_->header_limit(header_limit);
  parser_->body_limit(Sessions::most_notes_bytes);
  stream_.expires_after(request_timeout);
  http::async_read(stream_, in_, *parser_,
                   [self = shared_from_this()](beast::error_code error, std::size_t) { self->on_read(error); });
}

void HttpSession::on_read(beast::error_code error) {
  if (error) return close();
  const Request request = parser_->release();
  if (refuse_foreign(request)) return;
  beast::websocket::is_upgrade(request) ? upgrade(request) : answer(request);
}

/// A request under a name that is not ours is not answered, whatever it asks for: a foreign page may have let its own
/// name point here (DNS rebinding).
bool HttpSession::refuse_foreign(const Request& request) {
  beast::error_code error;
  const auto reached = stream_.socket().local_endpoint(error);
  const std::string_view host = view(request[http::field::host]);
  if (!error && request.count(http::field::host) == 1 && hosts_.allows(host, reached.address())) return false;
  send_text(request, http::status::misdirected_request, "text/plain; charset=utf-8",
            "This viewer does not answer to the name " + in_quotes(host) +
                ". Ask for it by its address, or start it with --host NAME to allow a name.\n");
  return true;
}

void HttpSession::upgrade(const Request& request) {
  if (request.target() != "/ws" && !request.target().starts_with("/ws?"))
    return send_text(request, http::status::not_found, "text/plain", "no WebSocket here\n");
  if (!same_site(request)) return send_text(request, http::status::forbidden, "text/plain", "foreign origin\n");
  const bool here = from_this_machine();
  std::make_shared<WsClient>(std::move(stream_), hub_, rights_of(role_of(view(request.target())), here))
      ->start(request);
}

bool HttpSession::from_this_machine() const {
  beast::error_code no_local, no_remote;
  const auto local = stream_.socket().local_endpoint(no_local), remote = stream_.socket().remote_endpoint(no_remote);
  return !no_local && !no_remote && (remote.address().is_loopback() || remote.address() == local.address());
}

/// /sessions, /sessions/NAME, /sessions/NAME/notes. A recording is a person's data and does not leave this machine.
void HttpSession::answer_session(const Request& request, const std::vector<std::string>& parts) {
  const auto refuse = [&](http::status status, std::string why) {
    send_text(request, status, "text/plain; charset=utf-8", std::move(why));
  };
  if (!from_this_machine())
    return refuse(http::status::forbidden, "recorded sessions are only for pages on this machine\n");
  const bool stores = request.method() == http::verb::put;
  const bool notes = parts.size() == 3 && parts[2] == "notes";
  if (stores && !notes) return refuse(http::status::method_not_allowed, "only notes can be stored\n");
  if (parts.size() == 1) return send_text(request, http::status::ok, "application/json", sessions_.list());
  const auto file = sessions_.find(parts[1]);
  if (!file || parts.size() > 3 || (parts.size() == 3 && !notes))
    return refuse(http::status::not_found, "there is no such session here\n");
  if (!notes) return send_recording(request, *file);
  if (!stores) return send_text(request, http::status::ok, "application/json", Sessions::notes(*file));
  if (!same_site(request)) return refuse(http::status::forbidden, "foreign origin\n");
  const std::string why = Sessions::store_notes(*file, request.body());
  if (!why.empty()) return refuse(http::status::bad_request, why + "\n");
  send_text(request, http::status::ok, "application/json", "{}\n");
}

/// /api/NAME. Runs are a person's data, and another exercise changes what the hands feel: only for pages on this
/// machine, and only from our own site where something changes.
void HttpSession::answer_training(const Request& request, const std::vector<std::string>& parts) {
  const auto refuse = [&](http::status status, const char* why) {
    send_text(request, status, "application/json", fmt::format("{{\"error\": \"{}\"}}\n", why));
  };
  if (!from_this_machine()) return refuse(http::status::forbidden, "only for pages on this machine");
  if (parts.size() != 2) return refuse(http::status::not_found, "not found");
  const std::string_view target = view(request.target());
  const std::size_t mark = target.find('?');
  const std::string_view query = mark == std::string_view::npos ? std::string_view() : target.substr(mark + 1);
  if (request.method() == http::verb::post) {
    if (!same_site(request)) return refuse(http::status::forbidden, "foreign origin");
    const ApiAnswer answer = training_.post(parts[1], request.body());
    return send_text(request, http::status(answer.status), "application/json", answer.json);
  }
  if (parts[1] == "picture") {
    const fs::path file = training_.picture(query_value(query, "scene"));
    return file.empty() ? refuse(http::status::not_found, "no picture") : send_file(request, file, "no-cache");
  }
  const ApiAnswer answer = training_.get(parts[1], query);
  send_text(request, http::status(answer.status), "application/json", answer.json);
}

void HttpSession::answer(const Request& request) {
  auto parts = split_target(view(request.target()));
  const bool session = parts && parts->front() == "sessions";
  const bool training = parts && parts->front() == "api";
  if (training && request.method() == http::verb::post) return answer_training(request, *parts);
  if (session && request.method() == http::verb::put) return answer_session(request, *parts);
  if (request.method() != http::verb::get && request.method() != http::verb::head)
    return send_text(request, http::status::method_not_allowed, "text/plain", "only GET and HEAD\n");
  if (session) return answer_session(request, *parts);
  if (training) return answer_training(request, *parts);
  const auto not_found = [&] { send_text(request, http::status::not_found, "text/plain", "not found\n"); };
  if (!parts) return not_found();
  if (*parts == std::vector<std::string>{"healthz"})
    return send_text(request, http::status::ok, "application/json", hub_.health());
  if (parts->front() == "bundle") {
    if (parts->size() < 3) return not_found();
    const auto file = hub_.bundle().find((*parts)[1], {parts->begin() + 2, parts->end()});
    return file ? send_file(request, *file, "no-store") : not_found();
  }
  // A query belongs to the exercise's page: "/?role=instructor".
  if (parts->back().empty()) parts->back() = page_.start && request.target() == "/" ? "start.html" : "index.html";
  const auto file = page_.folder.empty() ? std::nullopt : file_below(page_.folder, *parts);
  if (file) {
    // Built assets carry a hash in their name; everything else must be asked for again.
    const bool hashed = parts->front() == "assets";
    const std::string_view caching = hashed ? "public, max-age=31536000, immutable" : "no-cache";
    // The build leaves a compressed copy beside each large text.
    const std::string copy = file->string() + ".gz";
    std::error_code error;
    const bool packed = accepts_gzip(view(request[http::field::accept_encoding])) && fs::is_regular_file(copy, error);
    return send_file(request, packed ? fs::path(copy) : *file, caching, packed);
  }
  if (page_.folder.empty() && parts->size() == 1 && parts->back().ends_with(".html"))
    return send_text(request, http::status::service_unavailable, "text/html; charset=utf-8", std::string(not_built));
  not_found();
}

void HttpSession::send_text(const Request& request, http::status status, std::string_view type, std::string body) {
  http::response<http::string_body> response{status, request.version()};
  response.set(http::field::content_type, beast::string_view(type.data(), type.size()));
  response.set(http::field::cache_control, "no-store");
  response.set("X-Content-Type-Options", "nosniff");
  response.keep_alive(request.keep_alive());
  if (request.method() == http::verb::head) {
    response.content_length(body.size());  // of what GET would give
  } else {
    response.body() = std::move(body);
    response.prepare_payload();
  }
  send(std::move(response));
}

/// `packed`: the file is compressed (name.gz), and the browser unpacks it.
void HttpSession::send_file(const Request& request, const std::filesystem::path& file, std::string_view caching,
                            bool packed) {
  http::file_body::value_type body;
  beast::error_code error;
  body.open(file.c_str(), beast::file_mode::scan, error);
  if (error) return send_text(request, http::status::not_found, "text/plain", "not found\n");
  const auto set_head = [&](auto& response) {
    const auto type = mime_type(packed ? file.parent_path() / file.stem() : file);
    if (packed) response.set(http::field::content_encoding, "gzip");
    response.set(http::field::content_type, beast::string_view(type.data(), type.size()));
    response.set(http::field::cache_control, beast::string_view(caching.data(), caching.size()));
    response.set("X-Content-Type-Options", "nosniff");
    response.keep_alive(request.keep_alive());
  };
  if (request.method() == http::verb::head) {
    http::response<http::empty_body> response{http::status::ok, request.version()};
    set_head(response);
    response.content_length(body.size());
    return send(std::move(response));
  }
  http::response<http::file_body> response{std::piecewise_construct, std::make_tuple(std::move(body)),
                                           std::make_tuple(http::status::ok, request.version())};
  set_head(response);
  response.prepare_payload();
  send(std::move(response));
}

void HttpSession::send_recording(const Request& request, const std::filesystem::path& file) {
  std::error_code error;
  const std::uint64_t size = fs::file_size(file, error);
  const auto range = byte_range(view(request[http::field::range]), error ? 0 : size);
  if (error || !range || request.method() != http::verb::get) return send_file(request, file, "no-store");
  http::response<http::string_body> response{http::status::partial_content, request.version()};
  response.set(http::field::content_type, "application/octet-stream");
  response.set(http::field::cache_control, "no-store");
  response.set("X-Content-Type-Options", "nosniff");
  response.keep_alive(request.keep_alive());
  const std::uint64_t length = std::min(range->length, most_part_bytes);
  if (length == 0) {
    response.result(http::status::range_not_satisfiable);
    response.set(http::field::content_range, fmt::format("bytes */{}", size));
  } else {
    std::string bytes(length, '\0');
    std::ifstream in(file, std::ios::binary);
    if (!in.seekg(std::streamoff(range->first)) || !in.read(bytes.data(), std::streamsize(length)))
      return send_text(request, http::status::not_found, "text/plain", "the recording cannot be read\n");
    const std::uint64_t last = range->first + length - 1;
    response.set(http::field::content_range, fmt::format("bytes {}-{}/{}", range->first, last, size));
    response.body() = std::move(bytes);
  }
  response.prepare_payload();
  send(std::move(response));
}

template <class Response>
void HttpSession::send(Response&& response) {
  using Value = std::decay_t<Response>;
  auto kept = std::make_shared<Value>(std::forward<Response>(response));
  http::async_write(stream_, *kept, [self = shared_from_this(), kept](beast::error_code error, std::size_t) {
    if (error || kept->need_eof()) return self->close();
    self->read();
  });
}

void HttpSession::close() {
  beast::error_code ignored;
  stream_.socket().shutdown(boost::asio::ip::tcp::socket::shutdown_send, ignored);
}

}  // namespace insula::gateway
