// SPDX-License-Identifier: GPL-3.0-or-later
// A thread that factorises one matrix at a time. The caller does not wait for it.
#pragma once
#include <condition_variable>
#include <memory>
#include <mutex>
#include <thread>

#include "core/linalg/fp16_factor.h"

namespace insula {

/// A factor for compliance, and a 16-bit copy of its numbers for approximate solves.
struct StaleFactor {
  explicit StaleFactor(const BlockMatrix& a);
  /// Another factor for matrices of the same pattern, without its symbolic work.
  StaleFactor(const StaleFactor& like) : full(like.full), fp16(full) {}
  /// False when `a` is not positive definite in single precision.
  bool factorise(const BlockMatrix& a);

  MultifrontalCholesky<float> full;
  Fp16Factor fp16;
};

class BackgroundFactor {
 public:
  ~BackgroundFactor();
  /// For matrices of the pattern of `a`, for which `like` was made. Starts the thread.
  void prepare(const BlockMatrix& a, const StaleFactor& like);

  enum class Answer { nothing_asked, not_yet, good, bad };
  bool idle();
  /// Copies `a` and starts its factorisation, when idle.
  void ask(const BlockMatrix& a);
  /// A successful result puts the new factor into `factor` and keeps the old one for the next request. Either result
  /// makes this idle again.
  Answer take(std::unique_ptr<StaleFactor>& factor, bool wait);
  /// Waits for the requested factor, and drops it.
  void drop();

 private:
  void work();

  enum class State { idle, asked, ready, failed };  ///< while asked, the thread owns factor and matrix
  std::unique_ptr<StaleFactor> factor_;
  BlockMatrix matrix_;
  std::thread thread_;
  std::mutex mutex_;
  std::condition_variable wake_, done_;
  State state_ = State::idle;
  bool stop_ = false;
};

}  // namespace insula
