// SPDX-License-Identifier: GPL-3.0-or-later
// Every index once, for any number of threads, loop after loop.
#include "core/base/workers.h"

#include <gtest/gtest.h>

#include <array>

namespace insula {
namespace {

TEST(Workers, DoesEveryIndexOnce) {
  for (int threads : {1, 2, 3, 8}) {
    Workers workers(threads);
    EXPECT_EQ(workers.threads(), threads);
    for (int round = 0; round < 3000; ++round) {
      const int count = round % 7;
      std::array<std::atomic<int>, 7> hits{};
      workers.run(count, [&](int i) { ++hits[std::size_t(i)]; });
      for (int i = 0; i < 7; ++i) ASSERT_EQ(hits[std::size_t(i)], i < count ? 1 : 0);
    }
  }
}

TEST(Workers, EndsWhileIdleAndRightAfterWork) {
  for (int k = 0; k < 200; ++k) {
    Workers workers(3);
    if (k % 2) workers.run(5, [](int) {});
  }
}

}  // namespace
}  // namespace insula
