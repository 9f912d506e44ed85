// SPDX-License-Identifier: GPL-3.0-or-later
// Fixed queue from one writing to one reading thread, without locks. If it is full, new samples are dropped and
// counted.
#pragma once
#include <array>
#include <atomic>
#include <cstddef>
#include <cstdint>

namespace insula {

/// `capacity` must be a power of two.
template <class T, std::size_t capacity>
class SampleRing {
  static_assert(capacity > 0 && (capacity & (capacity - 1)) == 0);

 public:
  bool push(const T& value) {
    const std::uint64_t head = head_.load(std::memory_order_relaxed);
    if (head - tail_.load(std::memory_order_acquire) == capacity) {
      dropped_.fetch_add(1, std::memory_order_relaxed);
      return false;
    }
    items_[head & (capacity - 1)] = value;
    head_.store(head + 1, std::memory_order_release);
    return true;
  }
  bool pop(T& into) {
    const std::uint64_t tail = tail_.load(std::memory_order_relaxed);
    if (tail == head_.load(std::memory_order_acquire)) return false;
    into = items_[tail & (capacity - 1)];
    tail_.store(tail + 1, std::memory_order_release);
    return true;
  }
  std::uint64_t dropped() const { return dropped_.load(std::memory_order_relaxed); }

 private:
  std::array<T, capacity> items_{};
  alignas(64) std::atomic<std::uint64_t> head_{0};
  alignas(64) std::atomic<std::uint64_t> tail_{0};
  std::atomic<std::uint64_t> dropped_{0};
};

}  // namespace insula
