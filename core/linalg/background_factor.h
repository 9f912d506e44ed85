// SPDX-License-Identifier: GPL-3.0-or-later
// A thread that factorises one matrix at a time, and whoever asked does not wait for it.
#pragma once
#include <condition_variable>
#include <memory>
#include <mutex>
#include <thread>

#include "core/linalg/fp16_factor.h"

namespace insula {

/// A factor for compliance, and its numbers in 16 bits for what need only be near.
struct StaleFactor {
  explicit StaleFactor(const BlockMatrix& a);
  /// Another one for matrices of the same pattern, without its symbolic work.
  StaleFactor(const StaleFactor& like) : full(like.full), fp16(full) {}
  /// False when `a` is not positive definite in single precision.
  bool factorise(const BlockMatrix& a);

  MultifrontalCholesky<float> full;
  Fp16Factor fp16;
};

class BackgroundFactor {
 public:
  ~BackgroundFactor();
  /// For matrices of the pattern of `a`, which `like` was made for; starts the thread.
  void prepare(const BlockMatrix& a, const StaleFactor& like);

  enum class Answer { nothing_asked, not_yet, good, bad };
  bool idle();
  /// Copies `a` and has it factorised, when idle.
  void ask(const BlockMatrix& a);
  /// A good answer leaves the new factor in `factor` and takes the old one for the next; good and bad make this idle again.
  Answer take(std::unique_ptr<StaleFactor>& factor, bool wait);
  /// Waits for what was asked, and drops it.
  void drop();

 private:
  void work();

  enum class State { idle, asked, ready, failed };  ///< while asked, factor and matrix are the thread's
  std::unique_ptr<StaleFactor> factor_;
  BlockMatrix matrix_;
  std::thread thread_;
  std::mutex mutex_;
  std::condition_variable wake_, done_;
  State state_ = State::idle;
  bool stop_ = false;
};

}  // namespace insula
