// SPDX-License-Identifier: GPL-3.0-or-later
// A few threads that share a loop. The assignment of indices to threads is not determined, so loop bodies must not
// depend on it. The bits of a step are then the same for any number of threads. The caller never waits for a thread
// that has not begun a piece. On a busy machine it does the whole loop itself.
#pragma once
#include <atomic>
#include <cstdint>
#include <thread>
#include <type_traits>
#include <vector>

namespace insula {

class Workers {
 public:
  /// Total number of threads, including the caller's. 0: the number of the machine's cores, at most 8.
  explicit Workers(int threads = 0);
  ~Workers();
  Workers(const Workers&) = delete;
  Workers& operator=(const Workers&) = delete;

  int threads() const { return int(threads_.size()) + 1; }
  /// Calls task(0) ... task(count - 1), each once, and returns when all are done. Allocates nothing.
  template <class F>
  void run(int count, F&& task) {
    run_raw(
        count, [](void* t, int i) { (*static_cast<std::remove_reference_t<F>*>(t))(i); }, &task);
  }

 private:
  using Call = void (*)(void*, int);
  void run_raw(int count, Call call, void* task);
  void work(std::uint64_t ticket);
  void loop();

  static constexpr std::uint64_t closed = 0xffffffff;  ///< low half of a ticket between loops
  std::vector<std::thread> threads_;
  std::atomic<std::uint64_t> ticket_{closed};  ///< high half: loop number; low half: next index
  std::atomic<int> count_{0}, done_{0};
  Call call_ = nullptr;
  void* task_ = nullptr;
  std::atomic<bool> stop_{false};
};

}  // namespace insula
