// SPDX-License-Identifier: GPL-3.0-or-later
// The bus between processes: LCM's protocol over UDP multicast, received only from this machine and with every size
// checked. LCM's own library does neither (docs/notes/bus-transport.md), so it is not used here. LCM's tools remain
// compatible.
#pragma once
#include <atomic>
#include <condition_variable>
#include <cstdint>
#include <deque>
#include <map>
#include <memory>
#include <mutex>
#include <string>
#include <thread>
#include <vector>

#include "core/bus/bus.h"
#include "core/bus/udp_socket.h"

namespace insula {

inline constexpr std::string_view default_lcm_url = "udpm://239.255.76.67:7667?ttl=0";

/// LCM_DEFAULT_URL when set and not empty, else default_lcm_url.
std::string lcm_url_from_environment();

class LcmBus final : public Bus {
 public:
  /// Bounds of the messages that wait for poll(). Beyond either bound the oldest messages are dropped.
  static constexpr std::size_t max_waiting = 4096, max_waiting_bytes = 64u << 20;

  /// `url`: a udpm URL; "" means that of lcm_url_from_environment(). Check good().
  explicit LcmBus(std::string_view url = {});
  ~LcmBus() override;
  LcmBus(const LcmBus&) = delete;
  LcmBus& operator=(const LcmBus&) = delete;

  bool publish(std::string_view channel, Bytes message) override;
  void subscribe(std::string_view channel, Handler handler) override;
  int poll(int timeout_ms) override;
  bool good() const override { return good_.load(std::memory_order_relaxed); }
  std::string error() const override;

  const std::string& url() const { return url_; }
  /// Number of malformed datagrams of this machine so far.
  std::uint64_t refused() const { return refused_.load(std::memory_order_relaxed); }

 private:
  struct Message {
    const std::string* channel;  // a key of handlers_, which is never erased
    std::vector<std::uint8_t> bytes;
  };
  void fail(const std::string& what);
  void receive();  // the receiving thread

  std::string url_;
  UdpmAddress address_;
  std::mutex send_mutex_;
  std::unique_ptr<UdpSender> sender_;
  std::uint32_t sequence_ = 0;

  std::unique_ptr<UdpReceiver> receiver_;
  std::thread thread_;
  std::mutex queue_mutex_;
  std::condition_variable arrived_;
  std::map<std::string, std::vector<Handler>, std::less<>>
      handlers_;  // changed by the polling thread under queue_mutex_
  std::deque<Message> queue_;
  std::size_t queue_bytes_ = 0;
  std::atomic<std::uint64_t> refused_{0};

  std::atomic<bool> good_{false};
  mutable std::mutex error_mutex_;
  std::string error_;
};

}  // namespace insula
