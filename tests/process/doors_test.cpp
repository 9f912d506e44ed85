// SPDX-License-Identifier: GPL-3.0-or-later
// What must not get in: malformed datagrams, datagrams of another machine, and pages of a foreign name. The processes
// are the real ones.
#include <gtest/gtest.h>
#include <netinet/ip.h>
#include <netinet/udp.h>

#include <nlohmann/json.hpp>

#include "tests/process/datagrams.h"
#include "tests/process/live_session.h"
#include "tests/process/network_rooms.h"
#include "tests/process/page.h"
#include "tests/process/web_request.h"

namespace insula {
namespace {

using namespace testing;

constexpr const char* group = "239.255.76.67";

class Doors : public LiveSession {
 protected:
  std::uint16_t bus_port() const { return parse_udpm_url(session_->url())->port; }
  /// All processes are those of the beginning, and frames go on.
  void expect_alive(std::int64_t engine, std::int64_t server) {
    const std::size_t frames = watcher_->frames(engine), samples = watcher_->samples().size();
    EXPECT_TRUE(
        wait_for([&] { return watcher_->frames(engine) > frames + 60 && watcher_->samples().size() > samples + 100; }));
    EXPECT_EQ(watcher_->frame_session(), engine);
    EXPECT_EQ(watcher_->last()->session, server);
    for (const char* name : {"engine", "haptic_server", "gateway"})
      EXPECT_EQ(session_->count(std::string(name) + " started"), 1) << name;
  }
};

TEST_F(Doors, TheTwoDatagramsThatEndLcm) {
  const std::int64_t engine = watcher_->frame_session(), server = watcher_->last()->session;
  const PlainSender evil(0);
  for (const auto channel :
       {channel::haptic_problem, channel::render_frame, channel::user_command, channel::scene_info}) {
    // In 32 bits the offset and 60,000 add up to 1000. LCM finds that small enough and writes 4 GB behind its buffer.
    EXPECT_TRUE(evil.send(fragment({7, 100'000, 0, 0, 3}, channel, 1000), group, bus_port()));
    EXPECT_TRUE(evil.send(fragment({7, 100'000, 0u - 59'000u, 1, 3}, channel, 60'000), group, bus_port()));
    EXPECT_TRUE(evil.send(fragment({8, 100'000, 0, 0, 3}, channel, 1000), group, bus_port()));
    EXPECT_TRUE(evil.send(fragment({8, 100'000, 0xFFFFFFFFu, 1, 3}, channel, 1), group, bus_port()));
  }
  expect_alive(engine, server);
}

TEST_F(Doors, AHundredThousandMalformedDatagramsChangeNothing) {
  const Page page(*session_);
  ASSERT_TRUE(wait_for([&] { return page.frames(watcher_->frame_session()).size() > 20; }));
  const std::int64_t engine = watcher_->frame_session(), server = watcher_->last()->session;
  const PlainSender evil(0);
  LcmBus listener(session_->url());
  listener.subscribe("NOTHING", [](Bytes) {});
  MalformedDatagrams malformed(2026);
  int sent = 0;
  for (int burst = 0; burst < 2000; ++burst) {
    for (int i = 0; i < 50; ++i) sent += evil.send(malformed.next(), group, bus_port());
    std::this_thread::sleep_for(1ms);  // so that receivers read them, and do not only lose them
  }
  EXPECT_EQ(sent, 100'000);
  EXPECT_TRUE(wait_for([&] { return listener.refused() > 20'000; })) << listener.refused();
  const std::size_t seen = page.frames(engine).size();
  EXPECT_TRUE(wait_for([&] { return page.frames(engine).size() > seen + 60; }));
  EXPECT_EQ(page.connections(), 1);
  expect_alive(engine, server);
  EXPECT_TRUE(watcher_->press(0.1)) << watcher_->force();
}

TEST_F(Doors, PagesOfAForeignNameAreNotAnswered) {
  const std::string port = std::to_string(session_->port());
  const auto status = [&](const std::string& request) {
    return web_request("127.0.0.1", session_->port(), request).status;
  };
  for (const std::string& host :
       {"127.0.0.1:" + port, "localhost:" + port, std::string("LOCALHOST."), std::string("[::1]:") + port}) {
    EXPECT_EQ(status(get_request("/healthz", "Host: " + host + "\r\n")), 200) << host;
    EXPECT_EQ(status(upgrade_request("Host: " + host + "\r\nOrigin: http://" + host + "\r\n")), 101) << host;
  }
  // A name that its owner lets point to 127.0.0.1: the browser takes page and WebSocket for one site.
  for (const std::string& host :
       {"evil.example:" + port, std::string("evil.example"), std::string("localhost.evil.example"),
        std::string("127.0.0.1.evil.example"), std::string("10.0.0.1"), std::string("[::2]"),
        std::string("0.0.0.0:") + port, std::string("localhost:80@evil.example"), std::string("")}) {
    for (const char* target : {"/", "/healthz", "/bundle/1/scene.json"})
      EXPECT_EQ(status(get_request(target, "Host: " + host + "\r\n")), 421) << host << target;
    EXPECT_EQ(status(upgrade_request("Host: " + host + "\r\nOrigin: http://" + host + "\r\n")), 421) << host;
    EXPECT_EQ(status(upgrade_request("Host: " + host + "\r\n")), 421) << host;
  }
  EXPECT_EQ(status(get_request("/healthz", "")), 421);
  EXPECT_EQ(status(get_request("/healthz", "Host: localhost\r\nHost: evil.example\r\n")), 421);
  for (const char* origin : {"http://evil.example", "null", "http://localhost.evil.example", "http://", "file://"})
    EXPECT_EQ(status(upgrade_request("Host: 127.0.0.1:" + port + "\r\nOrigin: " + origin + "\r\n")), 403) << origin;
  const WebAnswer answer = web_request("127.0.0.1", session_->port(), get_request("/", "Host: evil.example\r\n"));
  EXPECT_NE(answer.text.find("does not answer to the name \"evil.example\""), std::string::npos) << answer.text;
  EXPECT_NE(answer.text.find("--host NAME"), std::string::npos) << answer.text;
}

/// A session on a machine with a cable to a stranger.
class CabledDoors : public Doors {
 protected:
  void SetUp() override {
    rooms_ = std::make_unique<NetworkRooms>();
    if (!rooms_->ready() || !rooms_->enter_machine()) GTEST_SKIP() << "network namespaces are not permitted here";
    session_ = std::make_unique<PlaySession>();
    ASSERT_EQ(session_->start({"--listen", "0.0.0.0", "--host", "Trainer.local"}), "");
    watcher_ = std::make_unique<Watcher>(session_->url());
    ASSERT_TRUE(wait_for([&] { return session_->port() > 0 && watcher_->frames_now() > 20 && watcher_->last(); }))
        << session_->log();
  }
  void TearDown() override {
    LiveSession::TearDown();
    watcher_.reset();
    session_.reset();
    rooms_.reset();
  }
  nlohmann::json health() {
    const std::string text =
        web_request("127.0.0.1", session_->port(), get_request("/healthz", "Host: localhost\r\n")).text;
    return nlohmann::json::parse(text.substr(text.find("\r\n\r\n") + 4));
  }

  std::unique_ptr<NetworkRooms> rooms_;
};

/// A socket as LCM's own: every interface, every address. It shows what has reached the machine.
class OpenEar {
 public:
  explicit OpenEar(std::uint16_t port) : socket_(::socket(AF_INET, SOCK_DGRAM | SOCK_NONBLOCK | SOCK_CLOEXEC, 0)) {
    const int on = 1;
    ::setsockopt(socket_, SOL_SOCKET, SO_REUSEADDR, &on, sizeof on);
    sockaddr_in at{};
    at.sin_family = AF_INET;
    at.sin_port = htons(port);
    ::bind(socket_, reinterpret_cast<const sockaddr*>(&at), sizeof at);
    ip_mreq join{};
    ::inet_pton(AF_INET, group, &join.imr_multiaddr);
    ::setsockopt(socket_, IPPROTO_IP, IP_ADD_MEMBERSHIP, &join, sizeof join);
  }
  ~OpenEar() { ::close(socket_); }
  /// How many datagrams that begin like this one were heard since it was asked last.
  int heard(const Buffer& like) {
    Buffer in(65'536);
    int n = 0;
    for (ssize_t size; (size = ::recv(socket_, in.data(), in.size(), 0)) >= 0;)
      n += std::size_t(size) == like.size() && std::equal(like.begin(), like.end(), in.begin());
    return n;
  }

 private:
  int socket_;
};

/// A datagram to the group with the sender's address of another: needs the right to raw sockets.
bool send_spoofed(const Buffer& message, const char* from, std::uint16_t port) {
  iphdr ip{};
  udphdr udp{};
  ip.version = 4;
  ip.ihl = 5;
  ip.ttl = 1;
  ip.protocol = IPPROTO_UDP;
  ::inet_pton(AF_INET, from, &ip.saddr);
  ::inet_pton(AF_INET, group, &ip.daddr);
  udp.source = htons(40'000);
  udp.dest = htons(port);
  udp.len = htons(std::uint16_t(sizeof udp + message.size()));  // checksum 0: none
  Buffer packet(sizeof ip + sizeof udp);
  std::memcpy(packet.data(), &ip, sizeof ip);
  std::memcpy(packet.data() + sizeof ip, &udp, sizeof udp);
  packet.insert(packet.end(), message.begin(), message.end());
  const int raw = ::socket(AF_INET, SOCK_RAW | SOCK_CLOEXEC, IPPROTO_RAW);
  sockaddr_in to{};
  to.sin_family = AF_INET;
  to.sin_addr.s_addr = ip.daddr;
  const bool ok = ::sendto(raw, packet.data(), packet.size(), 0, reinterpret_cast<const sockaddr*>(&to), sizeof to) ==
                  ssize_t(packet.size());
  ::close(raw);
  return ok;
}

TEST_F(CabledDoors, NothingOfAnotherMachineIsHeard) {
  const std::int64_t engine = watcher_->frame_session(), server = watcher_->last()->session;
  insula_lcm::user_command_t command{};
  command.sender = "stranger";
  command.command = "message";  // the engine answers it with an event
  command.argument = "hello";
  Buffer message;
  ASSERT_TRUE(encode(command, message));
  const Buffer asks = short_datagram(channel::user_command, message);
  const Buffer garbage = short_datagram(channel::haptic_problem, Buffer(500, 0xA5));
  OpenEar ear(bus_port());
  int heard = 0;
  const auto refused_by_server = watcher_->status().messages_refused;
  ASSERT_TRUE(rooms_->enter_stranger());
  {
    const PlainSender stranger(1);
    for (int i = 0; i < 50; ++i) {
      for (const Buffer& bytes : {asks, garbage, short_datagram(channel::render_frame, Buffer(100, 0xA5))}) {
        EXPECT_TRUE(stranger.send(bytes, group, bus_port()));
        EXPECT_TRUE(stranger.send(bytes, NetworkRooms::machine_address, bus_port()));
        EXPECT_TRUE(send_spoofed(bytes, NetworkRooms::machine_address, bus_port()));
      }
      std::this_thread::sleep_for(5ms);
      heard += ear.heard(asks);
    }
  }
  ASSERT_TRUE(rooms_->enter_machine());
  EXPECT_GE(heard, 145)
      << "the datagrams did not reach the machine; this test shows nothing";  // a busy machine may lose some
  expect_alive(engine, server);
  EXPECT_TRUE(watcher_->events().empty()) << watcher_->events().back().text;
  EXPECT_EQ(health()["channels"]["RENDER_FRAME"]["refused"], 0);
  std::this_thread::sleep_for(1200ms);  // a status comes once a second
  EXPECT_EQ(watcher_->status().messages_refused, refused_by_server);

  // The same datagrams from this machine are heard, so the silence above was the door's.
  const PlainSender here(0);
  EXPECT_TRUE(wait_for([&] {
    for (const Buffer& bytes : {asks, garbage, short_datagram(channel::render_frame, Buffer(100, 0xA5))})
      here.send(bytes, group, bus_port());
    std::this_thread::sleep_for(20ms);
    return !watcher_->events().empty() && watcher_->status().messages_refused > refused_by_server &&
           health()["channels"]["RENDER_FRAME"]["refused"] > 0;
  }));
}

TEST_F(CabledDoors, OtherMachinesWatchAndWithoutALoginDoNoMore) {
  const std::string at = NetworkRooms::machine_address, port = std::to_string(session_->port());
  ASSERT_TRUE(rooms_->enter_stranger());
  const auto status = [&](const std::string& host, bool upgrade) {
    const std::string fields = "Host: " + host + "\r\n";
    return web_request(
               at, session_->port(),
               upgrade ? upgrade_request(fields + "Origin: http://" + host + "\r\n") : get_request("/healthz", fields))
        .status;
  };
  for (const std::string& host : {at + ":" + port, "trainer.local:" + port, std::string("TRAINER.LOCAL.")}) {
    EXPECT_EQ(status(host, false), 200) << host;
    EXPECT_EQ(status(host, true), 101) << host;
  }
  for (const std::string& host :
       {std::string("evil.example"), std::string(NetworkRooms::stranger_address), std::string("trainer")}) {
    EXPECT_EQ(status(host, false), 421) << host;
    EXPECT_EQ(status(host, true), 421) << host;
  }
  boost::asio::io_context io;
  boost::beast::websocket::stream<boost::asio::ip::tcp::socket> page(io);
  page.next_layer().connect({boost::asio::ip::make_address(at), std::uint16_t(session_->port())});
  page.handshake("trainer.local", "/ws");
  page.binary(true);
  const auto send = [&](std::string_view channel, const auto& m) {
    Buffer payload;
    ASSERT_TRUE(encode(m, payload));
    page.write(boost::asio::buffer(*gateway::frame(channel, payload)));
  };
  insula_lcm::hand_input_t hand{};
  hand.q[0] = 1;
  insula_lcm::user_command_t command{};
  command.sender = "instructor";
  command.command = "message";
  command.argument = "hello";
  send(channel::hand_input, hand);
  send(channel::user_command, command);
  ASSERT_TRUE(rooms_->enter_machine());
  EXPECT_TRUE(wait_for([&] { return health()["from_pages"]["refused"] == 2; }));
  EXPECT_EQ(health()["from_pages"]["accepted"], 0);
  EXPECT_TRUE(watcher_->events().empty()) << "the command was heard";
}

}  // namespace
}  // namespace insula
