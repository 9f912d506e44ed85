// SPDX-License-Identifier: GPL-3.0-or-later
// Stations that announce themselves by multicast DNS: two machines with a cable between them, and what is no station.
#include "viewer/gateway/service_discovery.h"

#include <gtest/gtest.h>

#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>
#include <thread>

#include "core/bus/mem_bus.h"
#include "core/testing/temp_folder.h"
#include "tests/process/network_rooms.h"
#include "viewer/gateway/client_for_test.h"
#include "viewer/gateway/gateway.h"

namespace insula::gateway {
namespace {

namespace http = boost::beast::http;
using namespace std::chrono_literals;
using insula::testing::NetworkRooms;
using nlohmann::json;

const auto nearby = boost::asio::ip::make_address("192.0.2.7");

TEST(ServiceDiscovery, ShowsOnlyWhatIsAStation) {
  const ServiceFields fields{{"txtvers", "1"}, {"tls", "1"}, {"path", "/"}, {"more", "later"}};
  const auto good = read_service("table 3 \xC3\xA4", nearby, 8080, fields);
  ASSERT_TRUE(good);
  EXPECT_EQ(good->url(), "https://192.0.2.7:8080/");
  EXPECT_EQ(good->name, "table 3 \xC3\xA4");
  EXPECT_EQ(read_service("a", nearby, 80, {{"tls", "0"}, {"path", "/"}})->url(), "http://192.0.2.7:80/");
  EXPECT_TRUE(read_service(std::string(63, 'x'), nearby, 80, fields));
  for (const std::string& name : {std::string(), std::string(64, 'x'), std::string("a\nb"), std::string("a\x7f"),
                                  std::string("\xff"), std::string("a\0b", 3)})
    EXPECT_FALSE(read_service(name, nearby, 80, fields)) << name;
  for (const char* address : {"0.0.0.0", "::", "127.0.0.1", "::1", "224.0.0.251", "ff02::fb", "fe80::1"})
    EXPECT_FALSE(read_service("a", boost::asio::ip::make_address(address), 80, fields)) << address;
  EXPECT_FALSE(read_service("a", nearby, 0, fields));
  for (const ServiceFields& wrong :
       {ServiceFields{}, {{"tls", "1"}}, {{"tls", "2"}, {"path", "/"}}, {{"tls", "1"}, {"path", "//evil.example/"}}})
    EXPECT_FALSE(read_service("a", nearby, 80, wrong));
}

TEST(ServiceDiscovery, TellsStationsOfOneNameApart) {
  const auto heard = [](const char* name, const char* host, const char* port, const char* machine) {
    return HeardStation{StationAddress{name, host, port, false, {}}, machine};
  };
  const auto found = distinct_stations(
      {heard("table", "192.0.2.9", "8080", "insula-b.local"), heard("table", "2001:db8::7", "8080", "insula-a.local"),
       heard("table", "192.0.2.7", "8080", "insula-a.local"), heard("desk", "192.0.2.8", "8080", "insula-c.local")},
      ServiceDiscovery::most_found);
  std::vector<std::string> shown;
  for (const StationAddress& one : found) shown.push_back(one.name + " " + one.url());
  EXPECT_EQ(shown, (std::vector<std::string>{"desk http://192.0.2.8:8080/", "table http://192.0.2.7:8080/",
                                             "table http://192.0.2.9:8080/"}));
  EXPECT_EQ(distinct_stations({heard("a", "192.0.2.1", "1", "x"), heard("b", "192.0.2.2", "1", "y")}, 1).size(), 1u);
}

/// A station that listens on all addresses of its machine, and may be asked from `instructor`.
class NetworkStation {
 public:
  explicit NetworkStation(const std::string& name, const std::string& listen = "0.0.0.0", bool discovery = true) {
    Options options;
    options.port = 0;
    options.listen = listen;
    options.station = name;
    options.discovery = discovery;
    gateway_ = std::make_unique<Gateway>(bus_, options);
    error = gateway_->start();
    if (error.empty()) error = gateway_->announcement_error();
  }
  json room() { return json::parse(pages::ask("127.0.0.1", gateway_->port(), {http::verb::get, "/api/room"}).body()); }
  /// Waits until the overview shows others of these names, and no more.
  std::vector<std::string> found(const std::vector<std::string>& wanted) {
    std::vector<std::string> names;
    for (int i = 0; i < 300; ++i) {
      names.clear();
      const json all = room();
      for (const json& each : all["found"]) names.push_back(each["name"]);
      if (names == wanted) break;
      std::this_thread::sleep_for(100ms);
    }
    return names;
  }
  std::uint16_t port() const { return gateway_->port(); }
  std::string error;

 private:
  std::shared_ptr<MemHub> hub_ = std::make_shared<MemHub>();
  MemBus bus_{hub_};
  std::unique_ptr<Gateway> gateway_;
};

using Names = std::vector<std::string>;

/// Machines with a cable: stations are made on the one whose namespace the test is in.
class DiscoveryByCable : public ::testing::Test {
 protected:
  void SetUp() override {
    if (!rooms_.ready()) GTEST_SKIP() << "network namespaces are not permitted here";
  }
  std::unique_ptr<NetworkStation> there(const std::string& name, const std::string& listen = "0.0.0.0",
                                        bool discovery = true) {
    EXPECT_TRUE(rooms_.enter_stranger());
    auto out = std::make_unique<NetworkStation>(name, listen, discovery);
    EXPECT_EQ(out->error, "");
    EXPECT_TRUE(rooms_.enter_machine());
    return out;
  }
  NetworkRooms rooms_;
};

TEST_F(DiscoveryByCable, StationsFindEachOtherAndVanish) {
  ASSERT_TRUE(rooms_.enter_machine());
  NetworkStation desk("desk");
  ASSERT_EQ(desk.error, "");
  auto one = there("table 1"), two = there("table 2", NetworkRooms::stranger_address);
  EXPECT_EQ(desk.found({"table 1", "table 2"}), (Names{"table 1", "table 2"})) << "and not itself";
  const json found = desk.room()["found"];
  EXPECT_EQ(found[0]["url"], "http://10.231.7.2:" + std::to_string(one->port()) + "/");
  EXPECT_EQ(found[1]["url"], "http://10.231.7.2:" + std::to_string(two->port()) + "/");
  EXPECT_EQ(desk.room()["stations"], json::array()) << "what is found is not asked";
  ASSERT_TRUE(rooms_.enter_stranger());
  EXPECT_EQ(one->found({"desk", "table 2"}), (Names{"desk", "table 2"})) << "also on the same machine";
  ASSERT_TRUE(rooms_.enter_machine());
  one.reset();
  EXPECT_EQ(desk.found({"table 2"}), Names{"table 2"});
  two.reset();
  EXPECT_EQ(desk.found({}), Names{});
}

TEST_F(DiscoveryByCable, OneNameOfTwoStationsGetsANumber) {
  ASSERT_TRUE(rooms_.enter_machine());
  NetworkStation desk("desk", "127.0.0.1");
  ASSERT_EQ(desk.error, "");
  const auto one = there("table");
  EXPECT_EQ(desk.found({"table"}), Names{"table"}) << "who is reached by nobody else finds others too";
  const NetworkStation two("table");  // on another machine than the first
  ASSERT_EQ(two.error, "");
  EXPECT_EQ(desk.found({"table", "table #2"}), (Names{"table", "table #2"}));
}

TEST_F(DiscoveryByCable, OneNameOfTwoStationsOfOneMachineGetsANumber) {
  ASSERT_TRUE(rooms_.enter_machine());
  NetworkStation desk("desk");
  const auto one = there("table"), two = there("table");
  EXPECT_EQ(desk.found({"table", "table #2"}), (Names{"table", "table #2"}));
}

TEST_F(DiscoveryByCable, AStationIsFoundWhenItsNetworkComesLater) {
  ASSERT_TRUE(rooms_.enter_stranger());
  ASSERT_EQ(std::system("ip addr flush dev cable0"), 0);
  const auto late = there("late");
  ASSERT_TRUE(rooms_.enter_machine());
  NetworkStation desk("desk");
  ASSERT_TRUE(rooms_.enter_stranger());
  ASSERT_EQ(std::system("ip addr add 10.231.7.9/24 dev cable0 && ip route add 224.0.0.0/4 dev cable0"), 0);
  ASSERT_TRUE(rooms_.enter_machine());
  EXPECT_EQ(desk.found({"late"}), Names{"late"});
  EXPECT_EQ(desk.room()["found"][0]["url"], "http://10.231.7.9:" + std::to_string(late->port()) + "/");
}

/// Avahi's own daemon in the calling thread's namespace. One runs at most, since its files have fixed places.
class AvahiDaemon {
 public:
  explicit AvahiDaemon(const std::filesystem::path& folder) {
    const std::filesystem::path settings = folder / "avahi.conf";
    std::ofstream(settings) << "[server]\nuse-ipv6=no\nenable-dbus=no\n[publish]\npublish-workstation=no\n";
    ready = run("--check") != 0 &&
            run("--daemonize --no-drop-root --no-chroot --no-rlimits --file " + settings.string()) == 0;
  }
  ~AvahiDaemon() {
    if (ready) run("--kill");
  }
  bool ready = false;

 private:
  static int run(const std::string& options) {
    return std::system(("/usr/sbin/avahi-daemon " + options + " > /dev/null 2>&1").c_str());
  }
};

TEST_F(DiscoveryByCable, SharesThePortWithAvahisDaemon) {
  test_files::TempFolder folder;
  ASSERT_TRUE(rooms_.enter_machine());
  const AvahiDaemon daemon(folder.path());
  if (!daemon.ready) GTEST_SKIP() << "no avahi-daemon here, or one that runs";
  auto desk = std::make_unique<NetworkStation>("desk");
  ASSERT_EQ(desk->error, "");
  const auto one = there("table 1");
  EXPECT_EQ(desk->found({"table 1"}), Names{"table 1"});
  ASSERT_TRUE(rooms_.enter_stranger());
  EXPECT_EQ(one->found({"desk"}), Names{"desk"});
  desk.reset();
  EXPECT_EQ(one->found({}), Names{}) << "its farewell is heard";
}

TEST_F(DiscoveryByCable, NothingIsAnnouncedWithoutNeed) {
  ASSERT_TRUE(rooms_.enter_machine());
  NetworkStation desk("desk");
  const auto alone = there("own machine alone", "127.0.0.1"), off = there("switched off", "0.0.0.0", false),
             shown = there("shown");
  EXPECT_EQ(desk.found({"shown"}), Names{"shown"});
  std::this_thread::sleep_for(2s);  // an announcement takes less than a second
  EXPECT_EQ(desk.found({"shown"}), Names{"shown"});
  ASSERT_TRUE(rooms_.enter_stranger());
  const json told = off->room();
  EXPECT_EQ(told["found"], json::array());
  EXPECT_EQ(told["search_error"], "it is switched off");
}

}  // namespace
}  // namespace insula::gateway
