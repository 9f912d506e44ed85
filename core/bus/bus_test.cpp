// SPDX-License-Identifier: GPL-3.0-or-later
// Both buses: delivery, order, several endpoints; LCM only where the machine lets multicast through.
#include <gtest/gtest.h>
#include <lcm/lcm.h>

#include <chrono>
#include <cstdlib>
#include <numeric>
#include <stdexcept>
#include <thread>

#include "core/bus/channels.h"
#include "core/bus/lcm_bus.h"
#include "core/bus/mem_bus.h"
#include "core/testing/multicast.h"

namespace insula {
namespace {

using Buffer = std::vector<std::uint8_t>;

TEST(MemBus, DeliversInOrderToEverySubscriber) {
  auto hub = std::make_shared<MemHub>();
  MemBus a(hub), b(hub), c(hub);
  std::vector<int> at_a, at_b;
  a.subscribe("X", [&](Bytes m) { at_a.push_back(m[0]); });
  b.subscribe("X", [&](Bytes m) { at_b.push_back(m[0]); });
  b.subscribe("Y", [&](Bytes m) { at_b.push_back(100 + m[0]); });
  for (std::uint8_t i = 0; i < 5; ++i) {
    EXPECT_TRUE(c.publish("X", Buffer{i}));
    EXPECT_TRUE(a.publish("Y", Buffer{i}));
  }
  EXPECT_EQ(b.poll(0), 10);
  EXPECT_EQ(a.poll(0), 5);
  EXPECT_EQ(c.poll(0), 0);
  EXPECT_EQ(at_a, (std::vector<int>{0, 1, 2, 3, 4}));
  EXPECT_EQ(at_b, (std::vector<int>{0, 100, 1, 101, 2, 102, 3, 103, 4, 104}));
}

TEST(MemBus, HandlersMayPublish) {
  MemBus bus;
  int seen = 0;
  bus.subscribe("X", [&](Bytes m) {
    ++seen;
    if (m[0] > 0) bus.publish("X", Buffer{std::uint8_t(m[0] - 1)});
  });
  bus.publish("X", Buffer{3});
  while (bus.poll(0) > 0) {
  }
  EXPECT_EQ(seen, 4);
}

TEST(MemBus, KeepsTheNewestWhenNobodyPolls) {
  MemBus bus;
  std::vector<std::uint8_t> first;
  bus.subscribe("X", [&](Bytes m) {
    if (first.empty()) first.assign(m.begin(), m.end());
  });
  for (std::size_t i = 0; i < MemHub::capacity + 3; ++i) bus.publish("X", Buffer{std::uint8_t(i)});
  EXPECT_EQ(bus.dropped(), 3u);
  EXPECT_EQ(bus.poll(0), int(MemHub::capacity));
  EXPECT_EQ(first, Buffer{3});
}

TEST(MemBus, WakesAWaitingThread) {
  auto hub = std::make_shared<MemHub>();
  MemBus a(hub), b(hub);
  int got = 0;
  b.subscribe("X", [&](Bytes) { ++got; });
  std::thread sender([&] { a.publish("X", Buffer{1}); });
  while (got == 0) b.poll(100);
  sender.join();
  EXPECT_EQ(got, 1);
}

TEST(LcmBus, SaysWhatToDoWhenItCannotWork) {
  LcmBus bus("nonsense://");
  EXPECT_FALSE(bus.good());
  EXPECT_NE(bus.error().find("ip route add 224.0.0.0/4 dev lo"), std::string::npos) << bus.error();
  EXPECT_FALSE(bus.publish("X", Buffer{1}));
  EXPECT_EQ(bus.poll(0), 0);
}

TEST(LcmBus, MakeBusChoosesByUrl) {
  EXPECT_NE(dynamic_cast<MemBus*>(make_bus("memq://").get()), nullptr);
  EXPECT_NE(dynamic_cast<LcmBus*>(make_bus("nonsense://").get()), nullptr);
}

class LcmLoopback : public ::testing::Test {
 protected:
  void SetUp() override {
    const std::string url = testing::own_bus_url();
    sender_ = std::make_unique<LcmBus>(url);
    receiver_ = std::make_unique<LcmBus>(url);
    if (!sender_->good() || !receiver_->good()) GTEST_SKIP() << "no multicast here: " << sender_->error();
    receiver_->subscribe("PROBE", [this](Bytes) { ++probes_; });
    for (int i = 0; i < 50 && probes_ == 0; ++i) {
      sender_->publish("PROBE", Buffer{1});
      receiver_->poll(20);
    }
    if (probes_ == 0) GTEST_SKIP() << "multicast messages do not come back on this machine";
  }
  std::unique_ptr<LcmBus> sender_, receiver_;
  int probes_ = 0;
};

TEST_F(LcmLoopback, SmallAndLargeMessagesArriveWhole) {
  Buffer got;
  receiver_->subscribe("DATA", [&](Bytes m) { got.assign(m.begin(), m.end()); });
  for (std::size_t size : {std::size_t(1), std::size_t(1400), std::size_t(40'000), std::size_t(115'000)}) {
    Buffer sent(size);
    std::iota(sent.begin(), sent.end(), std::uint8_t(size));
    got.clear();
    for (int attempt = 0; attempt < 5 && got.empty(); ++attempt) {
      EXPECT_TRUE(sender_->publish("DATA", sent)) << sender_->error();
      for (int i = 0; i < 50 && got.empty(); ++i) receiver_->poll(10);
    }
    EXPECT_EQ(got, sent) << size;
  }
}

TEST_F(LcmLoopback, HandlerExceptionsComeOutOfPoll) {
  receiver_->subscribe("BOOM", [](Bytes) { throw std::runtime_error("boom"); });
  bool thrown = false;
  for (int i = 0; i < 50 && !thrown; ++i) {
    sender_->publish("BOOM", Buffer{1});
    try {
      receiver_->poll(20);
    } catch (const std::runtime_error&) {
      thrown = true;
    }
  }
  EXPECT_TRUE(thrown);
}

TEST_F(LcmLoopback, OrderAndBurstsAreKept) {
  std::vector<std::uint8_t> got;
  receiver_->subscribe("BURST", [&](Bytes m) { got.push_back(m[0]); });
  for (int i = 0; i < 200; ++i) ASSERT_TRUE(sender_->publish("BURST", Buffer{std::uint8_t(i)}));
  for (int i = 0; i < 50 && got.size() < 200; ++i) receiver_->poll(20);
  Buffer expected(200);
  std::iota(expected.begin(), expected.end(), std::uint8_t(0));
  EXPECT_EQ(got, expected);
}

TEST_F(LcmLoopback, MessagesBeyondTheLimitAreRefusedBySenders) {
  EXPECT_FALSE(sender_->publish("DATA", Buffer(max_message_bytes + 1)));
  EXPECT_FALSE(sender_->good());
  EXPECT_NE(sender_->error().find("524289 bytes"), std::string::npos) << sender_->error();
}

/// LCM's own library at the other end: its tools must be able to listen and to talk.
TEST_F(LcmLoopback, TalksWithLcmItself) {
  if (!testing::lcm_tools_work()) GTEST_SKIP() << "LCM has no multicast route here";
  lcm_t* lcm = lcm_create((receiver_->url() + "&recv_buf_size=2097152").c_str());
  ASSERT_NE(lcm, nullptr);
  Buffer at_lcm, here;
  const auto keep = [](const lcm_recv_buf_t* b, const char*, void* to) {
    const auto* p = static_cast<const std::uint8_t*>(b->data);
    static_cast<Buffer*>(to)->assign(p, p + b->data_size);
  };
  lcm_subscribe(lcm, "TO_LCM", keep, &at_lcm);
  receiver_->subscribe("FROM_LCM", [&](Bytes m) { here.assign(m.begin(), m.end()); });
  for (const std::size_t size : {std::size_t(3), std::size_t(100'000)}) {
    Buffer sent(size);
    std::iota(sent.begin(), sent.end(), std::uint8_t(1));
    at_lcm.clear();
    here.clear();
    for (int i = 0; i < 20 && at_lcm != sent; ++i) {
      sender_->publish("TO_LCM", sent);
      lcm_handle_timeout(lcm, 50);
    }
    for (int i = 0; i < 20 && here != sent; ++i) {
      lcm_publish(lcm, "FROM_LCM", sent.data(), unsigned(sent.size()));
      receiver_->poll(50);
    }
    EXPECT_EQ(at_lcm, sent);
    EXPECT_EQ(here, sent);
  }
  lcm_destroy(lcm);
}

TEST_F(LcmLoopback, LongChannelNamesAreRefused) {
  EXPECT_FALSE(sender_->publish(std::string(64, 'x'), Buffer{1}));
  EXPECT_FALSE(sender_->good());
  EXPECT_TRUE(sender_->publish("PROBE", Buffer{1}));
  EXPECT_TRUE(sender_->good());
}

}  // namespace
}  // namespace insula
