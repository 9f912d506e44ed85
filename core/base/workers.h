// SPDX-License-Identifier: GPL-3.0-or-later
// A few threads that share a loop. Which thread does which index is open, so loop bodies must not depend on it: then the
// bits of a step are the same for any number of threads.
#pragma once
#include <atomic>
#include <functional>
#include <thread>
#include <vector>

namespace insula {

class Workers {
 public:
  /// threads in all, the caller's included; 0: as many as the machine has cores, at most 8.
  explicit Workers(int threads = 0);
  ~Workers();
  Workers(const Workers&) = delete;
  Workers& operator=(const Workers&) = delete;

  int threads() const { return int(threads_.size()) + 1; }
  /// Calls task(0) ... task(count - 1), each once, and returns when all are done. Allocates nothing.
  template <class F>
  void run(int count, F&& task) {
    run_raw(count, [](void* t, int i) { (*static_cast<std::remove_reference_t<F>*>(t))(i); }, &task);
  }

 private:
  using Call = void (*)(void*, int);
  void run_raw(int count, Call call, void* task);
  void work();
  void loop();

  std::vector<std::thread> threads_;
  std::atomic<std::uint64_t> round_{0};
  std::atomic<int> next_{0}, busy_{0};
  int count_ = 0;
  Call call_ = nullptr;
  void* task_ = nullptr;
  std::atomic<bool> stop_{false};
};

}  // namespace insula
