// SPDX-License-Identifier: GPL-3.0-or-later
#include "core/linalg/background_factor.h"

#include "core/base/this_process.h"

namespace insula {
namespace {

MultifrontalCholesky<float> analysed(const BlockMatrix& a) {
  MultifrontalCholesky<float> factor;
  factor.analyse(a);
  return factor;
}

}  // namespace

StaleFactor::StaleFactor(const BlockMatrix& a) : full(analysed(a)), fp16(full) {}

bool StaleFactor::factorise(const BlockMatrix& a) {
  if (!full.factorise(a)) return false;
  fp16.round();
  return true;
}

void BackgroundFactor::prepare(const BlockMatrix& a, const StaleFactor& like) {
  factor_ = std::make_unique<StaleFactor>(like);
  matrix_ = a;
  if (!thread_.joinable()) thread_ = std::thread([this] { work(); });
}

bool BackgroundFactor::idle() {
  std::lock_guard lock(mutex_);
  return state_ == State::idle;
}

void BackgroundFactor::ask(const BlockMatrix& a) {
  if (!idle()) return;
  matrix_ = a;  // same pattern, so nothing is allocated
  {
    std::lock_guard lock(mutex_);
    state_ = State::asked;
  }
  wake_.notify_one();
}

BackgroundFactor::Answer BackgroundFactor::take(std::unique_ptr<StaleFactor>& factor, bool wait) {
  std::unique_lock lock(mutex_);
  if (state_ == State::idle) return Answer::nothing_asked;
  if (wait) done_.wait(lock, [this] { return state_ != State::asked; });
  if (state_ == State::asked) return Answer::not_yet;
  const bool good = state_ == State::ready;
  state_ = State::idle;
  if (!good) return Answer::bad;
  std::swap(factor, factor_);
  return Answer::good;
}

void BackgroundFactor::drop() {
  std::unique_lock lock(mutex_);
  done_.wait(lock, [this] { return state_ != State::asked; });
  state_ = State::idle;
}

void BackgroundFactor::work() {
  lower_priority_of_this_thread();  // it runs beside the step and the servo
  std::unique_lock lock(mutex_);
  for (;;) {
    wake_.wait(lock, [this] { return state_ == State::asked || stop_; });
    if (stop_) return;
    lock.unlock();
    const bool good = factor_->factorise(matrix_);
    lock.lock();
    state_ = good ? State::ready : State::failed;
    done_.notify_all();
  }
}

BackgroundFactor::~BackgroundFactor() {
  {
    std::lock_guard lock(mutex_);
    stop_ = true;
  }
  wake_.notify_one();
  if (thread_.joinable()) thread_.join();
}

}  // namespace insula
