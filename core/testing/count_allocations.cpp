// SPDX-License-Identifier: GPL-3.0-or-later
// Allocation functions of a test program. They count, and on request their addresses ascend or descend.
#include "core/testing/count_allocations.h"

#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <new>

std::atomic<long> allocations{0};

namespace {

/// Memory that is given out once, from both of its ends. The system provides only the pages that are used.
struct Arena {
  static constexpr std::size_t size = std::size_t(1) << 30;
  enum Mode { off, up, down };
  std::atomic<int> mode{off};
  std::atomic<std::uintptr_t> start{0}, low{0}, high{0};

  void* take(std::size_t bytes, std::size_t alignment) {
    if (mode.load() == up) {
      std::uintptr_t from = low.load(), at = 0;
      do at = (from + alignment - 1) / alignment * alignment;
      while (at + bytes <= high.load() && !low.compare_exchange_weak(from, at + bytes));
      return at + bytes <= high.load() ? reinterpret_cast<void*>(at) : nullptr;
    }
    std::uintptr_t end = high.load(), at = 0;
    do at = (end - bytes) / alignment * alignment;
    while (at >= low.load() && !high.compare_exchange_weak(end, at));
    return at >= low.load() ? reinterpret_cast<void*>(at) : nullptr;
  }
  bool owns(const void* p) const {
    const auto at = reinterpret_cast<std::uintptr_t>(p);
    return start.load() != 0 && at >= start.load() && at < start.load() + size;
  }
};
Arena arena;

void* counted(std::size_t size, std::size_t alignment) noexcept {
  allocations.fetch_add(1, std::memory_order_relaxed);
  if (size == 0) size = 1;
  if (arena.mode.load(std::memory_order_relaxed) != Arena::off)
    if (void* p = arena.take(size, alignment)) return p;
  if (alignment <= alignof(std::max_align_t)) return std::malloc(size);
  return std::aligned_alloc(alignment, (size + alignment - 1) / alignment * alignment);
}
void* counted(std::size_t size) noexcept { return counted(size, alignof(std::max_align_t)); }
void* counted(std::size_t size, std::align_val_t a) noexcept { return counted(size, std::size_t(a)); }
void* or_throw(void* p) {
  if (!p) throw std::bad_alloc();
  return p;
}
void release(void* p) noexcept {
  if (!arena.owns(p)) std::free(p);
}

}  // namespace

namespace insula::test {

OrderedHeap::OrderedHeap(Order order) {
  if (arena.start.load() == 0) {
    const auto start = reinterpret_cast<std::uintptr_t>(std::malloc(Arena::size));
    if (!start) throw std::bad_alloc();
    arena.low = start;
    arena.high = start + Arena::size;
    arena.start = start;
  }
  arena.mode = order == ascending ? Arena::up : Arena::down;
}
OrderedHeap::~OrderedHeap() { arena.mode = Arena::off; }

}  // namespace insula::test

void* operator new(std::size_t n) { return or_throw(counted(n)); }
void* operator new[](std::size_t n) { return or_throw(counted(n)); }
void* operator new(std::size_t n, std::align_val_t a) { return or_throw(counted(n, a)); }
void* operator new[](std::size_t n, std::align_val_t a) { return or_throw(counted(n, a)); }
void* operator new(std::size_t n, const std::nothrow_t&) noexcept { return counted(n); }
void* operator new[](std::size_t n, const std::nothrow_t&) noexcept { return counted(n); }
void operator delete(void* p) noexcept { release(p); }
void operator delete[](void* p) noexcept { release(p); }
void operator delete(void* p, std::size_t) noexcept { release(p); }
void operator delete[](void* p, std::size_t) noexcept { release(p); }
void operator delete(void* p, std::align_val_t) noexcept { release(p); }
void operator delete[](void* p, std::align_val_t) noexcept { release(p); }
void operator delete(void* p, std::size_t, std::align_val_t) noexcept { release(p); }
void operator delete[](void* p, std::size_t, std::align_val_t) noexcept { release(p); }
void operator delete(void* p, const std::nothrow_t&) noexcept { release(p); }
void operator delete[](void* p, const std::nothrow_t&) noexcept { release(p); }
