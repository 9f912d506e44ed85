// SPDX-License-Identifier: GPL-3.0-or-later
// The in-process bus.
#include "core/bus/mem_bus.h"

#include <algorithm>
#include <chrono>

namespace insula {

MemBus::MemBus(std::shared_ptr<MemHub> hub) : hub_(std::move(hub)) {
  std::lock_guard lock(hub_->mutex_);
  hub_->endpoints_.push_back(this);
}

MemBus::~MemBus() {
  std::lock_guard lock(hub_->mutex_);
  std::erase(hub_->endpoints_, this);
}

bool MemBus::publish(std::string_view channel, Bytes message) {
  auto bytes = std::make_shared<const std::vector<std::uint8_t>>(message.begin(), message.end());
  std::lock_guard lock(hub_->mutex_);
  for (MemBus* endpoint : hub_->endpoints_) {
    if (endpoint->handlers_.find(channel) == endpoint->handlers_.end()) continue;
    if (endpoint->queue_.size() >= MemHub::capacity) {
      endpoint->queue_.pop_front();
      ++endpoint->dropped_;
    }
    endpoint->queue_.push_back({std::string(channel), bytes});
    endpoint->arrived_.notify_one();
  }
  return true;
}

void MemBus::subscribe(std::string_view channel, Handler handler) {
  std::lock_guard lock(hub_->mutex_);
  handlers_[std::string(channel)].push_back(std::move(handler));
}

int MemBus::poll(int timeout_ms) {
  std::deque<Message> batch;
  {
    std::unique_lock lock(hub_->mutex_);
    if (timeout_ms > 0)
      arrived_.wait_for(lock, std::chrono::milliseconds(timeout_ms), [this] { return !queue_.empty(); });
    batch.swap(queue_);
  }
  // Handlers run without the lock: they may publish. Only this thread changes handlers_.
  int handled = 0;
  for (const Message& message : batch) {
    const auto found = handlers_.find(message.channel);
    if (found == handlers_.end()) continue;
    for (const Handler& handler : found->second) handler(*message.bytes);
    ++handled;
  }
  return handled;
}

std::size_t MemBus::dropped() const {
  std::lock_guard lock(hub_->mutex_);
  return dropped_;
}

}  // namespace insula
