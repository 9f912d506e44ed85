// SPDX-License-Identifier: GPL-3.0-or-later
// Triple buffer and sample ring: one thread, then two.
#include "haptic_server/triple_buffer.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <memory>
#include <thread>

#include "haptic_server/sample_ring.h"
#include "haptic_server/scene_setup.h"

namespace insula {
namespace {

TEST(TripleBuffer, GivesTheNewestOnceAndKeepsIt) {
  TripleBuffer<int> b(-1);
  EXPECT_FALSE(b.update());
  EXPECT_EQ(b.front(), -1);
  for (int k = 1; k <= 3; ++k) {
    b.back() = k;
    b.publish();
  }
  EXPECT_TRUE(b.pending());
  EXPECT_TRUE(b.update());
  EXPECT_EQ(b.front(), 3);
  EXPECT_FALSE(b.update());
  EXPECT_EQ(b.front(), 3);
  b.back() = 4;  // not published: the reader's value stays
  EXPECT_FALSE(b.update());
  EXPECT_EQ(b.front(), 3);
}

TEST(TripleBuffer, TwoThreadsNeverShareASlot) {
  struct Value {
    std::array<long, 64> words{};
  };
  TripleBuffer<Value> b;
  constexpr long count = 100'000;
  std::thread writer([&] {
    for (long k = 1; k <= count; ++k) {
      b.back().words.fill(k);
      b.publish();
    }
  });
  long last = 0, taken = 0;
  while (last < count) {
    if (!b.update()) {
      std::this_thread::yield();
      continue;
    }
    ++taken;
    const Value& v = b.front();
    const long first = v.words[0];
    ASSERT_GT(first, last);                                                                        // newer each time
    ASSERT_TRUE(std::all_of(v.words.begin(), v.words.end(), [&](long w) { return w == first; }));  // never torn
    last = first;
  }
  writer.join();
  EXPECT_GT(taken, 0);
  EXPECT_FALSE(b.update());
}

TEST(SampleRing, KeepsOrderAndCountsWhatDoesNotFit) {
  SampleRing<int, 4> ring;
  for (int k = 0; k < 6; ++k) EXPECT_EQ(ring.push(k), k < 4);
  EXPECT_EQ(ring.dropped(), 2u);
  int value = -1;
  for (int k = 0; k < 4; ++k) {
    ASSERT_TRUE(ring.pop(value));
    EXPECT_EQ(value, k);
  }
  EXPECT_FALSE(ring.pop(value));
}

TEST(SampleRing, TwoThreads) {
  SampleRing<long, 1024> ring;
  constexpr long count = 100'000;
  std::thread writer([&] {
    for (long k = 0; k < count;)
      if (ring.push(k)) ++k;
      else std::this_thread::yield();
  });
  long value = 0;
  for (long expected = 0; expected < count;) {
    if (!ring.pop(value)) {
      std::this_thread::yield();
      continue;
    }
    ASSERT_EQ(value, expected++);
  }
  writer.join();
}

TEST(SetupExchange, ASetupLivesWhileItIsUsed) {
  SetupExchange exchange;
  EXPECT_EQ(exchange.take(), nullptr);
  std::atomic<bool> done{false};
  std::thread reader([&] {
    std::int64_t last = 0;
    while (!done.load()) {
      const SceneSetup* s = exchange.take();
      if (!s) continue;
      const std::int64_t session = s->session;
      const std::string shown = s->problem;  // freed memory would show in a sanitizer
      ASSERT_GE(session, last);
      ASSERT_EQ(shown, "setup number " + std::to_string(session));
      last = session;
    }
  });
  for (int k = 1; k <= 5000; ++k) {
    auto s = std::make_unique<SceneSetup>();
    s->session = k;
    s->problem = "setup number " + std::to_string(k);
    exchange.give(std::move(s));
  }
  done = true;
  reader.join();
  EXPECT_EQ(exchange.take()->session, 5000);
}

}  // namespace
}  // namespace insula
