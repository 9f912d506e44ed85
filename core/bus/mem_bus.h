// SPDX-License-Identifier: GPL-3.0-or-later
// A bus inside one process. Its endpoints share a hub. Messages arrive in the order in which they were published.
#pragma once
#include <condition_variable>
#include <cstdint>
#include <deque>
#include <map>
#include <memory>
#include <mutex>
#include <string>
#include <vector>

#include "core/bus/bus.h"

namespace insula {

class MemBus;

/// The common part of the endpoints. Thread-safe.
class MemHub {
 public:
  /// Largest number of waiting messages of an endpoint; beyond it the oldest is dropped.
  static constexpr std::size_t capacity = 4096;

 private:
  friend class MemBus;
  std::mutex mutex_;
  std::vector<MemBus*> endpoints_;  // in order of creation, which is the order of delivery
};

class MemBus final : public Bus {
 public:
  explicit MemBus(std::shared_ptr<MemHub> hub = std::make_shared<MemHub>());
  ~MemBus() override;
  MemBus(const MemBus&) = delete;
  MemBus& operator=(const MemBus&) = delete;

  bool publish(std::string_view channel, Bytes message) override;
  void subscribe(std::string_view channel, Handler handler) override;
  int poll(int timeout_ms) override;
  bool good() const override { return true; }
  std::string error() const override { return {}; }

  std::size_t dropped() const;  ///< messages lost because this endpoint did not poll

 private:
  struct Message {
    std::string channel;
    std::shared_ptr<const std::vector<std::uint8_t>> bytes;
  };
  std::shared_ptr<MemHub> hub_;
  std::map<std::string, std::vector<Handler>, std::less<>> handlers_;
  std::deque<Message> queue_;
  std::size_t dropped_ = 0;
  std::condition_variable arrived_;
};

}  // namespace insula
