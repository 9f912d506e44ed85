// SPDX-License-Identifier: GPL-3.0-or-later
// Counts what a test program allocates. A program that uses this header has counting allocation functions
// (count_allocations.cpp).
#pragma once
#include <atomic>

/// Calls of operator new since the program's start, all threads.
extern std::atomic<long> allocations;

namespace insula::test {

/// While one lives, each new allocation lies above, or below, the one before it. What depends on the order of pointers
/// comes out otherwise in the one than in the other. One at a time.
class OrderedHeap {
 public:
  enum Order { ascending, descending };
  explicit OrderedHeap(Order order);
  ~OrderedHeap();
  OrderedHeap(const OrderedHeap&) = delete;
  OrderedHeap& operator=(const OrderedHeap&) = delete;
};

}  // namespace insula::test
