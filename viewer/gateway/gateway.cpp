// SPDX-License-Identifier: GPL-3.0-or-later
// Threads and the listening socket of the gateway.
#include "viewer/gateway/gateway.h"

#include <fmt/format.h>

#include <atomic>
#include <boost/asio/io_context.hpp>
#include <boost/asio/ip/tcp.hpp>
#include <boost/asio/post.hpp>
#include <boost/asio/steady_timer.hpp>
#include <thread>

#include "viewer/gateway/http_session.h"
#include "viewer/gateway/hub.h"
#include "viewer/gateway/service_discovery.h"
#include "viewer/gateway/static_files.h"

namespace asio = boost::asio;
using asio::ip::tcp;

namespace insula::gateway {

struct Gateway::Impl {
  Impl(Bus& bus, Options o)
      : options(std::move(o)),
        hosts(options.hosts),
        page{options.page, options.start},
        sessions(options.sessions, options.session_files),
        training(options.training, options.asks),
        logins(options.secrets),
        audit(options.audit),
        login_api(logins, audit),
        tls(options.tls.certificate.empty() ? nullptr : server_context(options.tls)),
        hub(bus, [this](std::function<void()> f) { asio::post(io, std::move(f)); }) {
    audit.set_person([this] { return station.person(); });
  }

  Options options;
  AllowedHosts hosts;
  PageFolder page;
  Sessions sessions;
  TrainingApi training;
  Logins logins;
  Audit audit;
  LoginApi login_api;
  std::unique_ptr<asio::ssl::context> tls;
  asio::io_context io{1};
  tcp::acceptor acceptor{io};
  asio::steady_timer retry{io};
  asio::steady_timer repeat{io};
  asio::steady_timer studio_look{io};
  Hub hub;
  Station station{options.station, options.training.choice};
  ServiceDiscovery discovery;
  Room room{
      io, {options.stations, options.kept_stations}, options.secrets.key, options.discovery ? &discovery : nullptr};
  RoomAccess room_access{options.secrets, options.kept_key, [this](const Secrets& secrets) {
                           logins.set_secrets(secrets);
                           room.set_key(secrets.key);
                         }};
  Studio studio{options.studio};
  Site site{hub,   hosts,           page,    sessions, training,    logins, login_api,
            audit, options.is_here, station, room,     room_access, studio};
  std::atomic<bool> stopping{false};
  std::thread network, bus_thread;
  std::uint16_t port = 0;
  std::string announcement_error;

  std::string open();
  void announce();
  void accept();
  void repeat_hands();
  void look_after_studio();
};

std::string Gateway::Impl::open() {
  for (const std::string& name : options.hosts)
    if (!AllowedHosts::is_name(name)) return fmt::format("\"{}\" is no name of a host", name);
  boost::system::error_code error;
  const auto address = asio::ip::make_address(options.listen, error);
  if (error) return fmt::format("\"{}\" is no address to listen on", options.listen);
  for (int i = 0; i <= options.more_ports; ++i) {
    const int wanted = options.port == 0 ? 0 : options.port + i;
    if (wanted > 65535) break;
    const tcp::endpoint endpoint(address, std::uint16_t(wanted));
    acceptor.open(endpoint.protocol(), error);
    if (!error) acceptor.set_option(tcp::acceptor::reuse_address(true), error);  // a port whose old connections linger
    if (!error) acceptor.bind(endpoint, error);
    if (!error) acceptor.listen(tcp::acceptor::max_listen_connections, error);
    if (!error) {
      port = acceptor.local_endpoint().port();
      login_api.set_place(port, tls != nullptr);
      room_access.set_reachable(!acceptor.local_endpoint().address().is_loopback());
      return {};
    }
    boost::system::error_code ignored;
    acceptor.close(ignored);
    if (error != asio::error::address_in_use) break;
  }
  return fmt::format("cannot listen on {} port {}: {}", options.listen, options.port, error.message());
}

/// Only where other machines reach it.
void Gateway::Impl::announce() {
  const auto listen = acceptor.local_endpoint().address();
  if (!options.discovery || listen.is_loopback()) return;
  announcement_error = discovery.announce({station.name(), listen, port, tls != nullptr});
}

void Gateway::Impl::accept() {
  acceptor.async_accept([this](boost::system::error_code error, tcp::socket socket) {
    if (stopping) return;
    if (!error) {
      std::make_shared<HttpSession>(std::move(socket), tls.get(), site)->start();
      return accept();
    }
    // Out of file descriptors, most likely: wait for some to come back instead of spinning.
    retry.expires_after(std::chrono::milliseconds(100));
    retry.async_wait([this](boost::system::error_code stopped) {
      if (!stopped && !stopping) accept();
    });
  });
}

void Gateway::Impl::repeat_hands() {
  repeat.expires_after(Hub::repeat_period);
  repeat.async_wait([this](boost::system::error_code error) {
    if (error || stopping) return;
    hub.repeat_hands(std::chrono::steady_clock::now());
    repeat_hands();
  });
}

void Gateway::Impl::look_after_studio() {
  studio_look.expires_after(std::chrono::milliseconds(100));
  studio_look.async_wait([this](boost::system::error_code error) {
    if (error || stopping) return;
    studio.look();
    look_after_studio();
  });
}

Gateway::Gateway(Bus& bus, Options options) : impl_(std::make_unique<Impl>(bus, std::move(options))) {}

Gateway::~Gateway() { stop(); }

std::string Gateway::start() {
  if (std::string error = impl_->open(); !error.empty()) return error;
  impl_->hub.watch(impl_->station);
  impl_->room.start();
  impl_->announce();
  impl_->accept();
  impl_->repeat_hands();
  if (impl_->studio.offered()) impl_->look_after_studio();
  impl_->network = std::thread([this] { impl_->io.run(); });
  impl_->bus_thread = std::thread([this] {
    while (!impl_->stopping) impl_->hub.poll(50);
  });
  return {};
}

void Gateway::stop() {
  impl_->stopping = true;
  if (impl_->bus_thread.joinable()) impl_->bus_thread.join();
  impl_->io.stop();
  if (impl_->network.joinable()) impl_->network.join();
}

std::uint16_t Gateway::port() const { return impl_->port; }

const std::string& Gateway::announcement_error() const { return impl_->announcement_error; }

std::string Gateway::url() const {
  const std::string& at = impl_->options.listen;
  std::string host = at == "0.0.0.0" || at == "::" ? "localhost" : at;
  if (host.find(':') != std::string::npos) host = "[" + host + "]";
  return fmt::format("{}://{}:{}/", impl_->tls ? "https" : "http", host, impl_->port);
}

std::string Gateway::sessions_query() const {
  const std::vector<std::string>& names = impl_->sessions.given();
  if (names.empty()) return {};
  return "session=" + percent_encoded(names[0]) + (names.size() > 1 ? "&with=" + percent_encoded(names[1]) : "");
}

}  // namespace insula::gateway
