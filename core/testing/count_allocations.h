// SPDX-License-Identifier: GPL-3.0-or-later
// Counts the allocations of a test program. A program that uses this header has counting allocation functions
// (count_allocations.cpp).
#pragma once
#include <atomic>

/// Calls of operator new since the program's start, all threads.
extern std::atomic<long> allocations;

namespace insula::test {

/// While an object exists, the address of each new allocation is above, or below, that of the one before. Results that
/// depend on the order of pointers then differ. Only one may exist at a time.
class OrderedHeap {
 public:
  enum Order { ascending, descending };
  explicit OrderedHeap(Order order);
  ~OrderedHeap();
  OrderedHeap(const OrderedHeap&) = delete;
  OrderedHeap& operator=(const OrderedHeap&) = delete;
};

}  // namespace insula::test
