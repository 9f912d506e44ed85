// SPDX-License-Identifier: GPL-3.0-or-later
// LCM's protocol behind the Bus interface, with errors that say what to do.
#include "core/bus/lcm_bus.h"

#include <fmt/format.h>

#include <array>
#include <chrono>
#include <cstdlib>
#include <utility>

#include "core/bus/channels.h"
#include "core/bus/mem_bus.h"
#include "core/bus/udpm_packet.h"

namespace insula {
namespace {

constexpr int max_per_poll = 2000;
constexpr const char* advice =
    "Insula's processes talk over UDP multicast on this machine. Its loopback interface must be up:\n"
    "    ip link set lo up multicast on\n"
    "LCM's own tools also need a route for multicast. A machine without a network (a container, a laptop offline) has "
    "none:\n"
    "    ip route add 224.0.0.0/4 dev lo\n"
    "LCM_DEFAULT_URL gives another group and port, as in udpm://239.255.76.67:7668?ttl=0.";

}  // namespace

std::string lcm_url_from_environment() {
  const char* url = std::getenv("LCM_DEFAULT_URL");
  return url != nullptr && *url != '\0' ? std::string(url) : std::string(default_lcm_url);
}

LcmBus::LcmBus(std::string_view url) : url_(url.empty() ? lcm_url_from_environment() : std::string(url)) {
  const auto address = parse_udpm_url(url_);
  if (!address) {
    fail("this is no address of a bus:");
    return;
  }
  address_ = *address;
  sender_ = std::make_unique<UdpSender>(address_);
  good_ = sender_->error().empty();
  if (!good_) fail(fmt::format("cannot open ({})", sender_->error()));
}

LcmBus::~LcmBus() {
  if (receiver_) receiver_->wake();
  if (thread_.joinable()) thread_.join();
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
  if (!sender_) return false;
  if (channel.empty() || channel.size() > udpm::max_name_bytes) {
    fail(fmt::format("channel name \"{}\" is empty or longer than {} characters on", channel, udpm::max_name_bytes));
    return false;
  }
  if (message.size() > max_message_bytes) {
    fail(fmt::format("{} bytes on channel {} are more than the {} allowed over", message.size(), channel,
                     max_message_bytes));
    return false;
  }
  std::unique_lock lock(send_mutex_);
  const auto send = [this](const udpm::Datagram& d) { return sender_->send({d.head.data(), d.head_bytes}, d.payload); };
  if (!udpm::cut(channel, message, sequence_++, send)) {
    const std::string why = sender_->error();
    lock.unlock();
    fail(fmt::format("cannot send {} bytes on channel {} ({}) over", message.size(), channel, why));
    return false;
  }
  // A temporary failure of sending is over. An error of the receiver stays.
  if (!receiver_ || receiver_->error().empty()) good_.store(true, std::memory_order_relaxed);
  return true;
}

void LcmBus::subscribe(std::string_view channel, Handler handler) {
  if (!sender_) return;
  {
    std::lock_guard lock(queue_mutex_);
    handlers_[std::string(channel)].push_back(std::move(handler));
  }
  if (receiver_) return;
  std::lock_guard lock(send_mutex_);  // publish reads receiver_
  receiver_ = std::make_unique<UdpReceiver>(address_);
  if (!receiver_->error().empty()) return fail(fmt::format("cannot receive ({}) over", receiver_->error()));
  thread_ = std::thread([this] { receive(); });
}

void LcmBus::receive() {
  std::array<std::uint8_t, 65'536> datagram;
  udpm::Assembler assembler;
  udpm::Received received;
  std::uint64_t sender = 0;
  while (const std::size_t size = receiver_->receive(datagram, sender)) {
    const bool whole = assembler.add(sender, Bytes(datagram.data(), size), received);
    refused_.store(assembler.refused(), std::memory_order_relaxed);
    if (!whole) continue;
    std::unique_lock lock(queue_mutex_);
    const auto found = handlers_.find(received.channel);
    if (found == handlers_.end()) continue;
    queue_.push_back({&found->first, {received.message.begin(), received.message.end()}});
    queue_bytes_ += received.message.size();
    while (queue_.size() > max_waiting || queue_bytes_ > max_waiting_bytes) {
      queue_bytes_ -= queue_.front().bytes.size();
      queue_.pop_front();
    }
    lock.unlock();
    arrived_.notify_one();
  }
}

int LcmBus::poll(int timeout_ms) {
  std::unique_lock lock(queue_mutex_);
  if (queue_.empty() && timeout_ms > 0)
    arrived_.wait_for(lock, std::chrono::milliseconds(timeout_ms), [this] { return !queue_.empty(); });
  int handled = 0;
  for (; handled < max_per_poll && !queue_.empty(); ++handled) {
    const Message message = std::move(queue_.front());
    queue_bytes_ -= message.bytes.size();
    queue_.pop_front();
    const std::vector<Handler>& handlers = handlers_.find(*message.channel)->second;  // only this thread adds to them
    lock.unlock();  // handlers may publish, and they may throw
    for (const Handler& handler : handlers) handler(message.bytes);
    lock.lock();
  }
  return handled;
}

std::unique_ptr<Bus> make_bus(std::string_view url) {
  const std::string chosen = url.empty() ? lcm_url_from_environment() : std::string(url);
  if (chosen.starts_with("memq://")) return std::make_unique<MemBus>();
  return std::make_unique<LcmBus>(chosen);
}

}  // namespace insula
