// SPDX-License-Identifier: GPL-3.0-or-later
// LCM behind the Bus interface, with errors that say what to do.
#include "core/bus/lcm_bus.h"

#include <fmt/format.h>
#include <lcm/lcm.h>
#include <poll.h>

#include <algorithm>
#include <cerrno>
#include <chrono>
#include <cstdlib>
#include <cstring>
#include <thread>
#include <utility>

#include "core/bus/mem_bus.h"

namespace insula {
namespace {

constexpr int queue_capacity = 1000;  // LCM's own default of 30 loses small streams on a busy machine
constexpr int max_per_poll = 2000;
constexpr const char* advice =
    "Insula's processes talk over UDP multicast. A machine without a network (a container, a laptop offline) has no route "
    "for it; add one on the loopback interface:\n"
    "    ip link set lo up multicast on && ip route add 224.0.0.0/4 dev lo\n"
    "or choose another address and port with LCM_DEFAULT_URL.";

}  // namespace

std::string lcm_url_from_environment() {
  const char* url = std::getenv("LCM_DEFAULT_URL");
  return url != nullptr && *url != '\0' ? std::string(url) : std::string(default_lcm_url);
}

std::string with_receive_buffer(std::string_view url) {
  std::string out(url);
  if (!url.starts_with("udpm://") || url.find("recv_buf_size=") != std::string_view::npos) return out;
  if (url.find('?') == std::string_view::npos)
    out += '?';
  else if (!url.ends_with('?') && !url.ends_with('&'))
    out += '&';
  return out + "recv_buf_size=2097152";
}

struct LcmBus::Callback {
  static void call(const lcm_recv_buf_t* buffer, const char*, void* user) noexcept {
    auto* subscription = static_cast<Subscription*>(user);
    try {
      subscription->handler(Bytes(static_cast<const std::uint8_t*>(buffer->data), buffer->data_size));
    } catch (...) {  // must not pass through LCM, which is C
      subscription->bus->thrown_ = std::current_exception();
    }
  }
};

LcmBus::LcmBus(std::string_view url) : url_(with_receive_buffer(url.empty() ? lcm_url_from_environment() : std::string(url))) {
  lcm_ = lcm_create(url_.c_str());
  if (lcm_ == nullptr)
    fail("cannot open");
  else
    good_ = true;
}

LcmBus::~LcmBus() {
  if (lcm_ != nullptr) lcm_destroy(lcm_);
}

void LcmBus::fail(const std::string& what) {
  std::lock_guard lock(error_mutex_);
  error_ = fmt::format("LCM: {} {}\n{}", what, url_, advice);
  good_ = false;
}

std::string LcmBus::error() const {
  if (good()) return {};
  std::lock_guard lock(error_mutex_);
  return error_;
}

bool LcmBus::publish(std::string_view channel, Bytes message) {
  if (lcm_ == nullptr) return false;
  char name[LCM_MAX_CHANNEL_NAME_LENGTH + 1];
  if (channel.empty() || channel.size() > LCM_MAX_CHANNEL_NAME_LENGTH) {
    fail(fmt::format("channel name \"{}\" is empty or longer than {} characters on", channel, LCM_MAX_CHANNEL_NAME_LENGTH));
    return false;
  }
  std::memcpy(name, channel.data(), channel.size());
  name[channel.size()] = '\0';
  if (lcm_publish(lcm_, name, message.data(), unsigned(message.size())) != 0) {
    fail(fmt::format("cannot send {} bytes on channel {} ({}) over", message.size(), channel, std::strerror(errno)));
    return false;
  }
  good_.store(true, std::memory_order_relaxed);  // a passing failure (route gone and back) is over
  return true;
}

void LcmBus::subscribe(std::string_view channel, Handler handler) {
  if (lcm_ == nullptr) return;
  // LCM reads the name as a regular expression; ours are plain words.
  auto subscription = std::make_unique<Subscription>(Subscription{this, std::move(handler)});
  lcm_subscription_t* handle =
      lcm_subscribe(lcm_, std::string(channel).c_str(), &Callback::call, subscription.get());
  if (handle == nullptr) {
    fail(fmt::format("cannot receive channel {} over", channel));
    return;
  }
  lcm_subscription_set_queue_capacity(handle, queue_capacity);
  subscriptions_.push_back(std::move(subscription));
}

int LcmBus::poll(int timeout_ms) {
  if (lcm_ == nullptr || subscriptions_.empty()) {
    // Nothing can arrive; a caller's loop must not spin.
    if (timeout_ms > 0) std::this_thread::sleep_for(std::chrono::milliseconds(timeout_ms));
    return 0;
  }
  pollfd wait{lcm_get_fileno(lcm_), POLLIN, 0};
  int handled = 0;
  for (int timeout = std::max(timeout_ms, 0); handled < max_per_poll; timeout = 0) {
    if (::poll(&wait, 1, timeout) <= 0 || !(wait.revents & POLLIN)) break;
    if (lcm_handle(lcm_) != 0) break;
    ++handled;
    if (thrown_) std::rethrow_exception(std::exchange(thrown_, nullptr));
  }
  return handled;
}

std::unique_ptr<Bus> make_bus(std::string_view url) {
  const std::string chosen = url.empty() ? lcm_url_from_environment() : std::string(url);
  if (chosen.starts_with("memq://")) return std::make_unique<MemBus>();
  return std::make_unique<LcmBus>(chosen);
}

}  // namespace insula
