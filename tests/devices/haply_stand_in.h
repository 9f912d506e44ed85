// SPDX-License-Identifier: GPL-3.0-or-later
// A stand-in for the Haply Inverse Service: it sends an inventory to each client, then one state for each message.
#pragma once
#include <boost/asio/io_context.hpp>
#include <boost/asio/ip/tcp.hpp>
#include <boost/beast/core.hpp>
#include <boost/beast/websocket.hpp>

#include <atomic>
#include <memory>
#include <mutex>
#include <nlohmann/json.hpp>
#include <string>
#include <thread>
#include <vector>

#include "core/base/math.h"

namespace insula::testing {

class HaplyStandIn {
 public:
  struct Arm {
    std::string id, handedness, grip;
    Vec3 p = Vec3::Zero(), v = Vec3::Zero();
    Quat q = Quat::Identity();
    bool a = false, b = false, ready = true, plugged = true;
    Vec3 force = Vec3::Zero();  ///< received last
    long commands = 0;
  };

  explicit HaplyStandIn(std::vector<Arm> arms, bool session_id = true)
      : arms_(std::move(arms)), session_id_(session_id) {
    start(0);
  }
  ~HaplyStandIn() { stop(); }

  std::string url() const { return "ws://127.0.0.1:" + std::to_string(port_); }
  Arm arm(std::size_t i) const {
    std::lock_guard lock(mutex_);
    return arms_[i];
  }
  template <class Change>
  void change(std::size_t i, Change change) {
    std::lock_guard lock(mutex_);
    change(arms_[i]);
  }
  /// Answers with this text in place of states; empty: with states again.
  void answer(const std::string& text) {
    std::lock_guard lock(mutex_);
    answer_ = text;
  }
  /// Number of messages that were not a command of the service.
  long misunderstood() const { return misunderstood_; }
  std::string introduced_as() const {
    std::lock_guard lock(mutex_);
    return profile_;
  }
  void stop() {
    stopping_ = true;
    boost::system::error_code ignored;
    if (thread_.joinable()) {
      // Wakes the waiting accept.
      boost::asio::io_context context;
      boost::asio::ip::tcp::socket knock(context);
      knock.connect({boost::asio::ip::address_v4::loopback(), port_}, ignored);
      knock.close(ignored);
      {
        std::lock_guard lock(mutex_);
        for (int s : sockets_) ::shutdown(s, SHUT_RDWR);
      }
      thread_.join();
    }
    for (std::thread& t : sessions_) t.join();
    sessions_.clear();
  }
  void start_again() { start(port_); }

 private:
  using Tcp = boost::asio::ip::tcp;
  using Json = nlohmann::json;

  void start(unsigned short port) {
    stopping_ = false;
    acceptor_ = std::make_unique<Tcp::acceptor>(context_);
    acceptor_->open(Tcp::v4());
    acceptor_->set_option(Tcp::acceptor::reuse_address(true));
    acceptor_->bind({boost::asio::ip::address_v4::loopback(), port});
    acceptor_->listen();
    port_ = acceptor_->local_endpoint().port();
    thread_ = std::thread([this] {
      while (!stopping_) {
        Tcp::socket socket(context_);
        boost::system::error_code error;
        acceptor_->accept(socket, error);
        if (error || stopping_) break;
        std::lock_guard lock(mutex_);
        sockets_.push_back(socket.native_handle());
        sessions_.emplace_back([this, s = std::make_shared<Tcp::socket>(std::move(socket))] { session(*s); });
      }
      acceptor_.reset();
    });
  }

  static Json xyz(const Vec3& v) { return {{"x", v.x()}, {"y", v.y()}, {"z", v.z()}}; }

  std::string state(bool first) const {
    Json j;
    if (session_id_) j["session_id"] = 7;
    j["inverse3"] = j["wireless_verse_grip"] = Json::array();
    for (const Arm& a : arms_) {
      if (!a.plugged) continue;
      Json arm = {{"device_id", a.id},
                  {"state", {{"cursor_position", xyz(a.p)}, {"cursor_velocity", xyz(a.v)}}},
                  {"status", {{"calibrated", true}, {"ready", a.ready}}}};
      if (first) arm["config"] = {{"type", "inverse3"}, {"handedness", a.handedness}};
      j["inverse3"].push_back(arm);
      if (a.grip.empty()) continue;
      j["wireless_verse_grip"].push_back(
          {{"device_id", a.grip},
           {"state",
            {{"orientation", {{"x", a.q.x()}, {"y", a.q.y()}, {"z", a.q.z()}, {"w", a.q.w()}}},
             {"buttons", {{"a", a.a}, {"b", a.b}, {"c", false}}}}}});
    }
    return j.dump();
  }

  void take(const std::string& text) {
    const Json j = Json::parse(text, nullptr, false);
    const char* key = session_id_ ? "vector" : "values";
    bool good = false;
    if (j.is_object() && j.contains("inverse3"))
      for (const Json& device : j["inverse3"])
        for (Arm& a : arms_) {
          if (device.value("device_id", "") != a.id || !device["commands"].contains("set_cursor_force") ||
              !device["commands"]["set_cursor_force"].contains(key))
            continue;
          const Json& f = device["commands"]["set_cursor_force"][key];
          a.force = Vec3(f["x"], f["y"], f["z"]);
          ++a.commands;
          good = true;
        }
    if (j.is_object() && j.contains("session")) profile_ = j["session"]["configure"]["profile"].value("name", "");
    if (!good) ++misunderstood_;
  }

  void session(Tcp::socket& socket) {
    const int descriptor = socket.native_handle();
    try {
      boost::beast::websocket::stream<Tcp::socket&> stream(socket);
      stream.accept();
      stream.text(true);
      std::string out;
      {
        std::lock_guard lock(mutex_);
        out = answer_.empty() ? state(true) : answer_;
      }
      stream.write(boost::asio::buffer(out));
      boost::beast::flat_buffer in;
      while (!stopping_) {
        stream.read(in);
        {
          std::lock_guard lock(mutex_);
          take(boost::beast::buffers_to_string(in.data()));
          out = answer_.empty() ? state(false) : answer_;
        }
        in.consume(in.size());
        stream.write(boost::asio::buffer(out));
      }
    } catch (const std::exception&) {  // the client has gone
    }
    std::lock_guard lock(mutex_);
    std::erase(sockets_, descriptor);
    boost::system::error_code ignored;
    socket.close(ignored);
  }

  mutable std::mutex mutex_;
  std::vector<Arm> arms_;
  bool session_id_;
  std::string answer_, profile_;
  std::atomic<long> misunderstood_{0};
  std::atomic<bool> stopping_{false};
  boost::asio::io_context context_;
  std::unique_ptr<Tcp::acceptor> acceptor_;
  unsigned short port_ = 0;
  std::thread thread_;
  std::vector<std::thread> sessions_;
  std::vector<int> sockets_;
};

/// Two arms with a grip each, as they come out of the box.
inline std::vector<HaplyStandIn::Arm> two_arms() {
  HaplyStandIn::Arm right{.id = "04BA", .handedness = "right", .grip = "61548"},
      left{.id = "049D", .handedness = "left", .grip = "61549"};
  right.p = left.p = Vec3(0, -0.12, 0.15);
  return {right, left};
}

}  // namespace insula::testing
