// SPDX-License-Identifier: GPL-3.0-or-later
// Passes the newest value from one writing to one reading thread, without locks or waiting.
#pragma once
#include <array>
#include <atomic>
#include <cstdint>

namespace insula {

/// Three slots: the writer owns one, the reader owns one, the third is between them. publish() swaps the writer's slot
/// with the middle one, update() the reader's. Values that were never read are overwritten. Both are wait-free.
template <class T>
class TripleBuffer {
 public:
  TripleBuffer() = default;
  /// Every slot starts as a copy of `start`, so that capacities can be reserved once.
  explicit TripleBuffer(const T& start) : slot_{start, start, start} {}
  TripleBuffer(const TripleBuffer&) = delete;
  TripleBuffer& operator=(const TripleBuffer&) = delete;

  /// The writer's slot, which holds an old value until it is written.
  T& back() { return slot_[write_]; }
  /// Passes back() to the reader and gives the writer another slot.
  void publish() {
    // release: the reader sees what was written; acquire: the reader is done with the slot that is taken over.
    write_ = middle_.exchange(std::uint8_t(write_ | fresh), std::memory_order_acq_rel) & index_mask;
  }

  /// Whether update() would take a value.
  bool pending() const { return (middle_.load(std::memory_order_relaxed) & fresh) != 0; }
  /// Takes the newest published value. False if nothing was published since the last call.
  bool update() {
    if (!pending()) return false;
    read_ = middle_.exchange(read_, std::memory_order_acq_rel) & index_mask;
    return true;
  }
  /// The reader's value, which stays until the next update().
  const T& front() const { return slot_[read_]; }

 private:
  static constexpr std::uint8_t fresh = 4;
  static constexpr std::uint8_t index_mask = 3;
  std::array<T, 3> slot_{};
  // Each thread's index on a cache line of its own.
  alignas(64) std::uint8_t write_ = 0;
  alignas(64) std::atomic<std::uint8_t> middle_{1};
  alignas(64) std::uint8_t read_ = 2;
};

}  // namespace insula
