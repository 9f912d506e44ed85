// SPDX-License-Identifier: GPL-3.0-or-later
// HTTP requests and their answers.
#include "viewer/gateway/http_session.h"

#include <fmt/format.h>

#include <algorithm>
#include <boost/beast/websocket.hpp>
#include <fstream>
#include <limits>
#include <type_traits>

#include "core/base/text.h"
#include "viewer/gateway/byte_range.h"
#include "viewer/gateway/scan_kind.h"
#include "viewer/gateway/static_files.h"
#include "viewer/gateway/ws_client.h"

namespace insula::gateway {
namespace {

constexpr auto request_timeout = std::chrono::seconds(30);
constexpr auto upload_timeout = std::chrono::minutes(5);
constexpr std::uint32_t header_limit = 16 * 1024;
/// A part that takes longer to read would delay pictures. A page asks again for the rest.
constexpr std::uint64_t most_part_bytes = 4 << 20;
constexpr std::size_t most_audited = 1000;  // of a request, bytes: texts of scenes are long
/// Reports and pictures of a case come from its author's file: nothing in them may run or load.
constexpr const char* file_policy = "sandbox; default-src 'none'; style-src 'unsafe-inline'; img-src data:";
constexpr std::string_view not_built =
    "<!doctype html><meta charset=utf-8><title>Insula</title><p>The viewer's page is not built. "
    "Run <code>npm ci &amp;&amp; npm run build</code> in <code>viewer/page</code>, then start again.</p>\n";

namespace fs = std::filesystem;

std::string_view view(beast::string_view s) { return {s.data(), s.size()}; }

}  // namespace

HttpSession::HttpSession(boost::asio::ip::tcp::socket&& socket, boost::asio::ssl::context* tls, const Site& site)
    : stream_(std::move(socket), tls), site_(site) {}

void HttpSession::start() {
  if (!stream_.encrypted()) return read();
  stream_.next_layer().expires_after(request_timeout);
  stream_.async_handshake([self = shared_from_this()](beast::error_code error) {
    if (!error) self->read();
  });
}

void HttpSession::read() {
  parser_.emplace();
  parser_->header_limit(header_limit);
  parser_->body_limit(std::numeric_limits<std::uint64_t>::max());  // it depends on what is asked for
  stream_.next_layer().expires_after(request_timeout);
  http::async_read_header(stream_, in_, *parser_, [self = shared_from_this()](beast::error_code error, std::size_t) {
    self->on_header(error);
  });
}

bool HttpSession::is_upload(const http::request_header<>& request) {
  const std::string_view target = view(request.target());
  return request.method() == http::verb::put && target.substr(0, target.find('?')) == "/api/studio/upload";
}

/// Only those who may use the page of the case builder can send a large body, and none of it is read before that is
/// known.
void HttpSession::on_header(beast::error_code error) {
  if (error) return close();
  const Request head{parser_->get().base()};
  if (is_upload(head)) return read_upload(head);
  if (parser_->content_length().value_or(0) > Sessions::most_notes_bytes) return close();
  parser_->body_limit(Sessions::most_notes_bytes);
  http::async_read(stream_, in_, *parser_,
                   [self = shared_from_this()](beast::error_code e, std::size_t) { self->on_read(e); });
}

/// It goes to the disk as it comes.
void HttpSession::read_upload(const Request& head) {
  if (refuse_foreign(head)) return;
  visitor_ = visitor_of(head);
  if (!site_.studio.offered() || visitor_.access < Access::instructor || !same_site(head))
    return send_error(head, http::status::forbidden, "only for pages on this machine and instructors");
  if (parser_->content_length().value_or(0) > most_scan_bytes)
    return send_error(head, http::status::payload_too_large, too_large_scan);
  incoming_ = std::make_unique<RemovedAtEnd>(site_.studio.incoming());
  upload_.emplace(std::move(*parser_));
  upload_->body_limit(most_scan_bytes);
  beast::error_code error;
  upload_->get().body().open(incoming_->path().c_str(), beast::file_mode::write, error);
  if (error) return send_error(head, http::status::insufficient_storage, "the file cannot be kept: is the disk full?");
  stream_.next_layer().expires_after(upload_timeout);
  http::async_read(stream_, in_, *upload_,
                   [self = shared_from_this()](beast::error_code e, std::size_t) { self->on_upload(e); });
}

void HttpSession::on_upload(beast::error_code error) {
  const Request head{upload_->get().base()};
  upload_.reset();
  if (error) incoming_.reset();
  if (error) return close();
  answer(head);
  incoming_.reset();
}

void HttpSession::on_read(beast::error_code error) {
  if (error) return close();
  const Request request = parser_->release();
  if (refuse_foreign(request)) return;
  visitor_ = visitor_of(request);
  if (refuse_strangers(request)) return;
  beast::websocket::is_upgrade(request) ? upgrade(request) : answer(request);
}

/// A page of another site may open a WebSocket to this one: browsers send its origin, which must be ours. The port may
/// differ (the page's development server). Programs that are no browsers send no origin.
bool HttpSession::same_site(const Request& request) {
  const std::string_view origin = view(request[http::field::origin]);
  if (origin.empty()) return true;
  const std::size_t scheme = origin.find("://");
  if (scheme == std::string_view::npos) return false;
  const std::string name = host_name(origin.substr(scheme + 3));
  return !name.empty() && name == host_name(view(request[http::field::host]));
}

/// A request under a name that is not ours is not answered, whatever it asks for: a foreign page may have let its own
/// name point here (DNS rebinding).
bool HttpSession::refuse_foreign(const Request& request) {
  beast::error_code error;
  const auto reached = socket().local_endpoint(error);
  const std::string_view host = view(request[http::field::host]);
  if (!error && request.count(http::field::host) == 1 && site_.hosts.allows(host, reached.address())) return false;
  send_text(request, http::status::misdirected_request, "text/plain; charset=utf-8",
            "This viewer does not answer to the name " + in_quotes(host) +
                ". Ask for it by its address, or start it with --host NAME to allow a name.\n");
  return true;
}

void HttpSession::upgrade(const Request& request) {
  if (request.target() != "/ws" && !request.target().starts_with("/ws?"))
    return send_text(request, http::status::not_found, "text/plain", "no WebSocket here\n");
  if (!same_site(request)) return send_text(request, http::status::forbidden, "text/plain", "foreign origin\n");
  std::make_shared<WsClient>(std::move(stream_), site_.hub, site_.audit, visitor_)->start(request);
}

/// What must log in is told from what is on this machine by the addresses of the connection.
Visitor HttpSession::visitor_of(const Request& request) {
  beast::error_code error;
  const auto remote = socket().remote_endpoint(error);
  Visitor out{error ? std::string() : remote.address().to_string(), Access::here, role_of(view(request.target()))};
  if (from_this_machine()) return out;
  const Credentials credentials =
      site_.login_api.credentials(view(request[http::field::cookie]), view(request[http::field::authorization]));
  out.access = site_.login_api.access_of(credentials, out.address);
  out.who = site_.login_api.who(credentials);
  return out;
}

/// Without a login, only the login page is to be had. It brings nothing of the session.
bool HttpSession::refuse_strangers(const Request& request) {
  if (visitor_.access != Access::none) return false;
  const std::string_view target = view(request.target());
  const std::string_view path = target.substr(0, target.find_first_of("?#"));
  if (path == "/login.html" || path == "/api/login" || path.starts_with("/assets/")) return false;
  const bool page = path == "/" || path.ends_with(".html");
  if (page && request.method() == http::verb::get) {
    const std::string to = "/login.html?next=" + percent_encoded(target.size() < 500 ? target : path);
    send_text(request, http::status::see_other, "text/plain", "log in first\n", {{http::field::location, to}});
  } else {
    send_error(request, http::status::unauthorized, "log in first");
  }
  return true;
}

bool HttpSession::from_this_machine() const {
  beast::error_code no_local, no_remote;
  const auto local = socket().local_endpoint(no_local), remote = socket().remote_endpoint(no_remote);
  return !no_local && !no_remote && site_.is_here(remote.address(), local.address());
}

/// GET and POST /api/login, POST /api/logout.
void HttpSession::answer_login(const Request& request, bool out) {
  const bool posts = request.method() == http::verb::post;
  if (!posts && !out)
    return send_text(request, http::status::ok, "application/json", site_.login_api.state(visitor_.access));
  if (!posts || !same_site(request)) return send_error(request, http::status::forbidden, "foreign origin");
  const Credentials credentials = site_.login_api.credentials(view(request[http::field::cookie]), {});
  const LoginApi::Answer answer =
      out ? site_.login_api.log_out(credentials) : site_.login_api.log_in(request.body(), visitor_.address);
  std::vector<std::pair<http::field, std::string>> fields;
  if (!answer.set_cookie.empty()) fields.emplace_back(http::field::set_cookie, answer.set_cookie);
  send_text(request, http::status(answer.status), "application/json", answer.json, fields);
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
  if (parts.size() == 1) return send_text(request, http::status::ok, "application/json", site_.sessions.list());
  const auto file = site_.sessions.find(parts[1]);
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
  const auto refuse = [&](http::status status, std::string_view why) { send_error(request, status, why); };
  if (!from_this_machine()) return refuse(http::status::forbidden, "only for pages on this machine");
  if (parts.size() != 2) return refuse(http::status::not_found, "not found");
  const std::string_view target = view(request.target());
  const std::size_t mark = target.find('?');
  const std::string_view query = mark == std::string_view::npos ? std::string_view() : target.substr(mark + 1);
  if (request.method() == http::verb::post) {
    if (!same_site(request)) return refuse(http::status::forbidden, "foreign origin");
    const ApiAnswer answer = site_.training.post(parts[1], request.body());
    site_.audit.write({visitor_.address, "here", 0, parts[1] + " " + request.body(), answer.status < 300,
                       answer.status < 300 ? "" : answer.json});
    return send_text(request, http::status(answer.status), "application/json", answer.json);
  }
  if (parts[1] == "picture") {
    const fs::path file = site_.training.picture(query_value(query, "scene"));
    return file.empty() ? refuse(http::status::not_found, "no picture") : send_file(request, file, "no-cache");
  }
  const ApiAnswer answer = site_.training.get(parts[1], query);
  send_text(request, http::status(answer.status), "application/json", answer.json);
}

/// /api/studio/NAME. The page of the case builder is for this machine and for instructors. Sessions are started here,
/// so that only this machine's pages play.
void HttpSession::answer_studio(const Request& request, const std::vector<std::string>& parts) {
  const auto refuse = [&](http::status status, std::string_view why) { send_error(request, status, why); };
  if (!site_.studio.offered()) return refuse(http::status::not_found, "start the case builder's page: insula studio");
  if (visitor_.access < Access::instructor)
    return refuse(http::status::forbidden, "only for pages on this machine and instructors");
  if (parts.size() != 3) return refuse(http::status::not_found, "not found");
  const std::string_view target = view(request.target());
  const std::string_view query = target.substr(std::min(target.find('?'), target.size() - 1) + 1);
  const bool changes = request.method() == http::verb::post || request.method() == http::verb::put;
  if (changes && !same_site(request)) return refuse(http::status::forbidden, "foreign origin");
  if ((parts[2] == "play" || parts[2] == "scene_look") && visitor_.access != Access::here)
    return refuse(http::status::forbidden, "exercises are played at the machine of the case builder");
  ApiAnswer answer;
  if (is_upload(request) && incoming_) answer = site_.studio.upload(query, incoming_->path());
  else if (request.method() == http::verb::post) answer = site_.studio.post(parts[2], request.body());
  else if (const auto file = site_.studio.file(parts[2], query)) return send_file(request, *file, "no-store");
  else answer = site_.studio.get(parts[2], query);
  if (changes)
    site_.audit.write({visitor_.address, std::string(name_of(visitor_.access)), 0,
                       "studio " + parts[2] + " " +
                           (is_upload(request) ? std::string(query) : request.body().substr(0, most_audited)),
                       answer.status < 300, answer.status < 300 ? "" : answer.json, visitor_.who});
  send_text(request, http::status(answer.status), "application/json", answer.json);
}

void HttpSession::answer(const Request& request) {
  auto parts = split_target(view(request.target()));
  const bool session = parts && parts->front() == "sessions";
  const bool training = parts && parts->front() == "api";
  if (training && parts->size() == 2 && (parts->back() == "login" || parts->back() == "logout"))
    return answer_login(request, parts->back() == "logout");
  if (training && parts->size() >= 2 && ((*parts)[1] == "station" || (*parts)[1] == "room" || (*parts)[1] == "ticket"))
    return answer_room(request, *parts);
  if (training && parts->size() >= 2 && (*parts)[1] == "studio") return answer_studio(request, *parts);
  if (training && request.method() == http::verb::post) return answer_training(request, *parts);
  if (session && request.method() == http::verb::put) return answer_session(request, *parts);
  if (request.method() != http::verb::get && request.method() != http::verb::head)
    return send_text(request, http::status::method_not_allowed, "text/plain", "only GET and HEAD\n");
  if (session) return answer_session(request, *parts);
  if (training) return answer_training(request, *parts);
  const auto not_found = [&] { send_text(request, http::status::not_found, "text/plain", "not found\n"); };
  if (!parts) return not_found();
  if (*parts == std::vector<std::string>{"healthz"})
    return send_text(request, http::status::ok, "application/json", site_.hub.health());
  if (parts->front() == "bundle") {
    if (parts->size() < 3) return not_found();
    const auto file = site_.hub.bundle().find((*parts)[1], {parts->begin() + 2, parts->end()});
    return file ? send_file(request, *file, "no-store") : not_found();
  }
  // A query belongs to the exercise's page: "/?role=instructor".
  if (parts->back().empty())
    parts->back() = request.target() != "/"  ? "index.html"
                    : site_.studio.offered() ? "studio.html"
                    : site_.page.start       ? "start.html"
                                             : "index.html";
  const auto file = site_.page.folder.empty() ? std::nullopt : file_below(site_.page.folder, *parts);
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
  if (site_.page.folder.empty() && parts->size() == 1 && parts->back().ends_with(".html"))
    return send_text(request, http::status::service_unavailable, "text/html; charset=utf-8", std::string(not_built));
  not_found();
}

void HttpSession::send_error(const Request& request, http::status status, std::string_view why) {
  send_text(request, status, "application/json", fmt::format("{{\"error\": \"{}\"}}\n", why));
}

void HttpSession::send_text(const Request& request, http::status status, std::string_view type, std::string body,
                            const std::vector<std::pair<http::field, std::string>>& fields) {
  http::response<http::string_body> response{status, request.version()};
  response.set(http::field::content_type, beast::string_view(type.data(), type.size()));
  response.set(http::field::cache_control, "no-store");
  response.set("X-Content-Type-Options", "nosniff");
  for (const auto& [field, value] : fields) response.set(field, value);
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
    if (request.target().starts_with("/api/studio/")) response.set("Content-Security-Policy", file_policy);
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
  socket().shutdown(boost::asio::ip::tcp::socket::shutdown_send, ignored);
}

}  // namespace insula::gateway
