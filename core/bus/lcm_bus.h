// SPDX-License-Identifier: GPL-3.0-or-later
// The bus between processes: LCM over UDP multicast.
#pragma once
#include <atomic>
#include <exception>
#include <memory>
#include <mutex>
#include <string>
#include <vector>

#include "core/bus/bus.h"

struct _lcm_t;

namespace insula {

inline constexpr std::string_view default_lcm_url = "udpm://239.255.76.67:7667?ttl=0";

/// LCM_DEFAULT_URL when set and not empty, else default_lcm_url.
std::string lcm_url_from_environment();
/// The URL with recv_buf_size=2097152 appended when it is a udpm URL that does not set it (a kernel caps it silently at
/// net.core.rmem_max; asking is free).
std::string with_receive_buffer(std::string_view url);

class LcmBus final : public Bus {
 public:
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

 private:
  struct Subscription {
    LcmBus* bus;
    Handler handler;
  };
  struct Callback;  // the function LCM calls, in lcm_bus.cpp
  void fail(const std::string& what);

  std::string url_;
  _lcm_t* lcm_ = nullptr;
  std::vector<std::unique_ptr<Subscription>> subscriptions_;
  std::exception_ptr thrown_;  // by a handler, on its way out of poll
  std::atomic<bool> good_{false};
  mutable std::mutex error_mutex_;
  std::string error_;
};

}  // namespace insula
