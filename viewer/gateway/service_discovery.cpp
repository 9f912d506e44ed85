// SPDX-License-Identifier: GPL-3.0-or-later
// On Avahi's core library, which needs no daemon. It works in a thread of its own.
#include "viewer/gateway/service_discovery.h"

#include <avahi-common/alternative.h>
#include <avahi-common/domain.h>
#include <avahi-common/error.h>
#include <avahi-common/malloc.h>
#include <avahi-common/thread-watch.h>
#include <avahi-common/timeval.h>
#include <avahi-core/core.h>
#include <avahi-core/log.h>
#include <avahi-core/lookup.h>
#include <avahi-core/publish.h>
#include <ifaddrs.h>
#include <net/if.h>

#include <algorithm>
#include <cstring>
#include <mutex>
#include <tuple>
#include <utility>

#include "core/base/system_random.h"
#include "core/base/text.h"

namespace insula::gateway {
namespace {

namespace asio = boost::asio;

constexpr std::size_t longest_name = AVAHI_LABEL_MAX - 1;  // of a service: 63 bytes
constexpr unsigned most_records = 1024;                    // kept of each network
constexpr unsigned look_again_ms = 5000;                   // whether the own addresses have changed
constexpr std::size_t most_followed =
    4 * ServiceDiscovery::most_found;  // a station is found once by network and protocol

bool is_control(char c) { return static_cast<unsigned char>(c) < 0x20 || c == 0x7f; }

/// A name as a service may have it, cut at a character's border.
std::string service_name(std::string name) {
  std::erase_if(name, is_control);
  if (name.size() > longest_name) name.resize(longest_name);
  const std::size_t bad = find_invalid_utf8(name);
  if (bad != name.npos) name.resize(bad);
  return name.empty() ? "station" : name;
}

/// Unique, so that it never collides with the machine's own name or with another program's.
std::string new_host_name() { return "insula-" + system_random(10, "0123456789abcdefghijklmnopqrstuvwxyz"); }

asio::ip::address address_of(const AvahiAddress& a) {
  if (a.proto == AVAHI_PROTO_INET) return asio::ip::address_v4(ntohl(a.data.ipv4.address));
  asio::ip::address_v6::bytes_type bytes;
  std::copy_n(a.data.ipv6.address, bytes.size(), bytes.begin());
  return asio::ip::address_v6(bytes);
}

asio::ip::address address_of(const sockaddr* socket) {
  if (socket != nullptr && socket->sa_family == AF_INET)
    return asio::ip::address_v4(ntohl(reinterpret_cast<const sockaddr_in*>(socket)->sin_addr.s_addr));
  asio::ip::address_v6::bytes_type bytes{};
  if (socket != nullptr && socket->sa_family == AF_INET6)
    std::memcpy(bytes.data(), &reinterpret_cast<const sockaddr_in6*>(socket)->sin6_addr, bytes.size());
  return asio::ip::address_v6(bytes);
}

using OwnAddresses = std::vector<std::pair<AvahiIfIndex, asio::ip::address>>;

/// By which other machines reach a station that listens there, with their interfaces.
OwnAddresses own_addresses(const asio::ip::address& listen) {
  OwnAddresses out;
  ifaddrs* list = nullptr;
  if (getifaddrs(&list) != 0) return out;
  for (const ifaddrs* i = list; i != nullptr; i = i->ifa_next) {
    const asio::ip::address address = address_of(i->ifa_addr);
    const bool heard = listen.is_unspecified() ? listen.is_v6() || address.is_v4() : listen == address;
    if (heard && !address.is_unspecified() && !address.is_loopback())
      out.emplace_back(AvahiIfIndex(if_nametoindex(i->ifa_name)), address);
  }
  freeifaddrs(list);
  return out;
}

ServiceFields fields_of(AvahiStringList* list) {
  ServiceFields out;
  for (; list != nullptr && out.size() < 16; list = avahi_string_list_get_next(list)) {
    const std::string text(reinterpret_cast<const char*>(avahi_string_list_get_text(list)),
                           avahi_string_list_get_size(list));
    const std::size_t equals = text.find('=');
    if (equals != text.npos) out.emplace(text.substr(0, equals), text.substr(equals + 1));
  }
  return out;
}

}  // namespace

std::optional<StationAddress> read_service(const std::string& name, const asio::ip::address& address,
                                           std::uint16_t port, const ServiceFields& fields) {
  const auto field = [&](const char* key) {
    const auto found = fields.find(key);
    return found == fields.end() ? std::string() : found->second;
  };
  const bool named = !name.empty() && name.size() <= longest_name && find_invalid_utf8(name) == name.npos &&
                     std::none_of(name.begin(), name.end(), is_control);
  // An address of a link alone needs the reader's interface, which no address of a page can name.
  const bool reachable = !address.is_unspecified() && !address.is_multicast() && !address.is_loopback() &&
                         !(address.is_v6() && address.to_v6().is_link_local());
  const std::string tls = field("tls");
  if (!named || !reachable || port == 0 || (tls != "0" && tls != "1") || field("path") != "/") return {};
  return StationAddress{name, address.to_string(), std::to_string(port), tls == "1", {}};
}

std::vector<StationAddress> distinct_stations(const std::vector<HeardStation>& heard, std::size_t most) {
  std::map<std::pair<std::string, std::string>, StationAddress> by_machine;
  for (const HeardStation& one : heard) {
    const auto [place, added] = by_machine.try_emplace({one.machine, one.address.port}, one.address);
    const bool plainer = one.address.host.find(':') == std::string::npos;
    if (!added && plainer) place->second = one.address;
  }
  std::vector<StationAddress> out;
  for (auto& [machine, station] : by_machine) out.push_back(std::move(station));
  std::sort(out.begin(), out.end(), [](const StationAddress& a, const StationAddress& b) {
    return std::pair(a.name, a.host_and_port()) < std::pair(b.name, b.host_and_port());
  });
  if (out.size() > most) out.resize(most);
  return out;
}

struct ServiceDiscovery::Impl {
  /// Of one service on one network by one protocol.
  using Key = std::tuple<AvahiIfIndex, AvahiProtocol, std::string>;
  struct Followed {
    AvahiSServiceResolver* resolver = nullptr;
    std::optional<HeardStation> station;  ///< nothing: it is not known yet, or it is no station
  };

  ~Impl() {
    if (poll == nullptr) return;
    avahi_threaded_poll_stop(poll);
    if (server != nullptr) avahi_server_free(server);  // with all that belongs to it
    avahi_threaded_poll_free(poll);
  }

  std::string start();
  void publish();
  void found(AvahiBrowserEvent event, const Key& key, const char* domain);
  void resolved(const Key& key, std::optional<HeardStation> station);

  static void on_server(AvahiServer* s, AvahiServerState state, void* self);
  static void on_group(AvahiServer* s, AvahiSEntryGroup* g, AvahiEntryGroupState state, void* self);
  static void on_time(AvahiTimeout* timeout, void* self);
  static void on_browser(AvahiSServiceBrowser* b, AvahiIfIndex interface, AvahiProtocol protocol,
                         AvahiBrowserEvent event, const char* name, const char* type, const char* domain,
                         AvahiLookupResultFlags flags, void* self);
  static void on_resolver(AvahiSServiceResolver* r, AvahiIfIndex interface, AvahiProtocol protocol,
                          AvahiResolverEvent event, const char* name, const char* type, const char* domain,
                          const char* host, const AvahiAddress* address, std::uint16_t port, AvahiStringList* fields,
                          AvahiLookupResultFlags flags, void* self);

  AvahiThreadedPoll* poll = nullptr;
  AvahiServer* server = nullptr;
  AvahiSEntryGroup* group = nullptr;
  AvahiSServiceBrowser* browser = nullptr;
  std::optional<Announcement> own;
  OwnAddresses addresses;  ///< that are announced
  mutable std::mutex mutex;
  std::map<Key, Followed> followed;  ///< `station` is read by other threads, under the mutex
};

/// With the server's options for `own`.
std::string ServiceDiscovery::Impl::start() {
  if (server != nullptr) return {};
  // The gateway's own lines say what matters.
  avahi_set_log_function([](AvahiLogLevel, const char*) {});
  AvahiServerConfig config;
  avahi_server_config_init(&config);
  const std::string host = new_host_name();
  config.host_name = avahi_strdup(host.c_str());
  config.use_ipv6 = config.publish_aaaa_on_ipv4 = !own || own->listen.is_v6();
  config.publish_addresses = config.publish_workstation = config.publish_hinfo = config.publish_domain = 0;
  config.enable_wide_area = config.enable_reflector = config.disallow_other_stacks = 0;
  config.check_response_ttl = 1;  // what was routed from another network is not taken
  config.disable_publishing = !own;
  config.n_cache_entries_max = most_records;
  if (poll == nullptr) poll = avahi_threaded_poll_new();
  int error = AVAHI_ERR_NO_MEMORY;
  if (poll != nullptr) server = avahi_server_new(avahi_threaded_poll_get(poll), &config, on_server, this, &error);
  avahi_server_config_free(&config);
  if (server == nullptr) return avahi_strerror(error);
  timeval next;
  const AvahiPoll* api = avahi_threaded_poll_get(poll);
  if (own) api->timeout_new(api, avahi_elapse_time(&next, look_again_ms, 0), on_time, this);
  return avahi_threaded_poll_start(poll) < 0 ? "there is no thread for it" : "";
}

/// Puts the own service into the group, which must be empty. The addresses belong to the group and not to the server,
/// which would also claim the way back from address to name. On one machine only one program can have that:
/// avahi-daemon, or another station.
void ServiceDiscovery::Impl::publish() {
  if (group == nullptr) group = avahi_s_entry_group_new(server, on_group, this);
  if (group == nullptr) return;
  const AvahiProtocol protocol = own->listen.is_v4() ? AVAHI_PROTO_INET : AVAHI_PROTO_UNSPEC;
  addresses = own_addresses(own->listen);
  for (const auto& [interface, each] : addresses) {
    AvahiAddress address;
    if (avahi_address_parse(each.to_string().c_str(), AVAHI_PROTO_UNSPEC, &address) != nullptr)
      avahi_server_add_address(server, group, interface, protocol, AVAHI_PUBLISH_NO_REVERSE,
                               avahi_server_get_host_name_fqdn(server), &address);
  }
  const bool one = !own->listen.is_unspecified() && !addresses.empty();
  avahi_server_add_service(server, group, one ? addresses.front().first : AVAHI_IF_UNSPEC, protocol,
                           AvahiPublishFlags(0), own->name.c_str(), type, nullptr, nullptr, own->port, "txtvers=1",
                           own->encrypted ? "tls=1" : "tls=0", "path=/", nullptr);
  avahi_s_entry_group_commit(group);
}

/// A network may come or change after the start.
void ServiceDiscovery::Impl::on_time(AvahiTimeout* timeout, void* self) {
  Impl& impl = *static_cast<Impl*>(self);
  if (impl.group != nullptr && avahi_server_get_state(impl.server) == AVAHI_SERVER_RUNNING &&
      own_addresses(impl.own->listen) != impl.addresses) {
    avahi_s_entry_group_reset(impl.group);
    impl.publish();
  }
  timeval next;
  avahi_threaded_poll_get(impl.poll)->timeout_update(timeout, avahi_elapse_time(&next, look_again_ms, 0));
}

/// May be called before avahi_server_new() has returned.
void ServiceDiscovery::Impl::on_server(AvahiServer* s, AvahiServerState state, void* self) {
  Impl& impl = *static_cast<Impl*>(self);
  impl.server = s;
  if (!impl.own) return;
  if (state == AVAHI_SERVER_COLLISION) avahi_server_set_host_name(s, new_host_name().c_str());
  if (state == AVAHI_SERVER_RUNNING && (impl.group == nullptr || avahi_s_entry_group_is_empty(impl.group)))
    impl.publish();
  if (state != AVAHI_SERVER_RUNNING && impl.group != nullptr) avahi_s_entry_group_reset(impl.group);
}

void ServiceDiscovery::Impl::on_group(AvahiServer*, AvahiSEntryGroup* g, AvahiEntryGroupState state, void* self) {
  if (state != AVAHI_ENTRY_GROUP_COLLISION) return;
  Impl& impl = *static_cast<Impl*>(self);
  char* other = avahi_alternative_service_name(impl.own->name.c_str());
  impl.own->name = other;
  avahi_free(other);
  avahi_s_entry_group_reset(g);
  impl.publish();
}

void ServiceDiscovery::Impl::on_browser(AvahiSServiceBrowser*, AvahiIfIndex interface, AvahiProtocol protocol,
                                        AvahiBrowserEvent event, const char* name, const char*, const char* domain,
                                        AvahiLookupResultFlags flags, void* self) {
  if (name == nullptr || (flags & AVAHI_LOOKUP_RESULT_LOCAL) != 0) return;
  static_cast<Impl*>(self)->found(event, {interface, protocol, name}, domain);
}

void ServiceDiscovery::Impl::found(AvahiBrowserEvent event, const Key& key, const char* domain) {
  const auto known = followed.find(key);
  if (event == AVAHI_BROWSER_REMOVE && known != followed.end()) {
    if (known->second.resolver != nullptr) avahi_s_service_resolver_free(known->second.resolver);
    const std::lock_guard lock(mutex);
    followed.erase(known);
  }
  if (event != AVAHI_BROWSER_NEW || known != followed.end() || followed.size() >= most_followed) return;
  const auto& [interface, protocol, name] = key;
  Followed* entry = nullptr;
  {
    const std::lock_guard lock(mutex);
    entry = &followed[key];
  }
  entry->resolver = avahi_s_service_resolver_new(server, interface, protocol, name.c_str(), type, domain,
                                                 AVAHI_PROTO_UNSPEC, AvahiLookupFlags(0), on_resolver, this);
}

void ServiceDiscovery::Impl::on_resolver(AvahiSServiceResolver*, AvahiIfIndex interface, AvahiProtocol protocol,
                                         AvahiResolverEvent event, const char* name, const char*, const char*,
                                         const char* host, const AvahiAddress* address, std::uint16_t port,
                                         AvahiStringList* fields, AvahiLookupResultFlags, void* self) {
  const bool there = event == AVAHI_RESOLVER_FOUND && address != nullptr;
  std::optional<HeardStation> station;
  if (there)
    if (const auto read = read_service(name, address_of(*address), port, fields_of(fields)))
      station = HeardStation{*read, host == nullptr ? "" : host};
  static_cast<Impl*>(self)->resolved({interface, protocol, name}, std::move(station));
}

void ServiceDiscovery::Impl::resolved(const Key& key, std::optional<HeardStation> station) {
  const std::lock_guard lock(mutex);
  const auto known = followed.find(key);
  if (known != followed.end()) known->second.station = std::move(station);
}

ServiceDiscovery::ServiceDiscovery() : impl_(std::make_unique<Impl>()) {}

ServiceDiscovery::~ServiceDiscovery() = default;

std::string ServiceDiscovery::announce(const Announcement& announcement) {
  impl_->own = announcement;
  impl_->own->name = service_name(announcement.name);
  return impl_->start();
}

std::string ServiceDiscovery::browse() {
  if (impl_->browser != nullptr) return {};
  if (std::string error = impl_->start(); !error.empty()) return error;
  avahi_threaded_poll_lock(impl_->poll);
  impl_->browser = avahi_s_service_browser_new(impl_->server, AVAHI_IF_UNSPEC, AVAHI_PROTO_UNSPEC, type, nullptr,
                                               AvahiLookupFlags(0), Impl::on_browser, impl_.get());
  const int error = impl_->browser == nullptr ? avahi_server_errno(impl_->server) : 0;
  avahi_threaded_poll_unlock(impl_->poll);
  return error == 0 ? "" : avahi_strerror(error);
}

std::vector<StationAddress> ServiceDiscovery::found() const {
  std::vector<HeardStation> heard;
  const std::lock_guard lock(impl_->mutex);
  for (const auto& [key, entry] : impl_->followed)
    if (entry.station) heard.push_back(*entry.station);
  return distinct_stations(heard, most_found);
}

}  // namespace insula::gateway
