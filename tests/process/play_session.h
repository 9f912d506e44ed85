// SPDX-License-Identifier: GPL-3.0-or-later
// A real `insula play` with its three processes, on a bus of its own, and somebody who watches that bus.
#pragma once
#include <gtest/gtest.h>
#include <signal.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <atomic>
#include <chrono>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <map>
#include <mutex>
#include <set>
#include <string>
#include <thread>
#include <vector>

#include "core/base/math.h"
#include "core/bus/codec.h"
#include "core/bus/lcm_bus.h"
#include "engine/child_process.h"
#include "core/testing/multicast.h"

namespace insula::testing {

namespace fs = std::filesystem;
using namespace std::chrono_literals;

/// Patience of every wait: far more than anything takes, so that only what never comes fails.
inline constexpr auto patience = 90s;

template <class Condition>
bool wait_for(Condition condition) {
  const auto end = std::chrono::steady_clock::now() + patience;
  while (std::chrono::steady_clock::now() < end) {
    if (condition()) return true;
    std::this_thread::sleep_for(5ms);
  }
  return condition();
}

inline std::int64_t now_us() {
  return std::chrono::duration_cast<std::chrono::microseconds>(std::chrono::steady_clock::now().time_since_epoch()).count();
}

/// One hand in one DEVICE_STATE.
struct Sample {
  std::int64_t session, sequence, time_us;
  std::array<Vec3, 2> force, position;
};

/// Collects what the processes say.
class Watcher {
 public:
  explicit Watcher(const std::string& url) : bus_(url), out_(url) {
    bus_.subscribe(channel::device_state, [this](Bytes b) { on_device(b); });
    bus_.subscribe(channel::render_frame, [this](Bytes b) {
      if (const auto m = decode<insula_lcm::render_frame_t>(b)) {
        std::lock_guard lock(mutex_);
        frames_[m->session].insert(m->sequence);
        frame_session_ = m->session;
        tool_states_.clear();
        for (const auto& t : m->tool) tool_states_.push_back(t.state);
      }
    });
    bus_.subscribe(channel::sim_event, [this](Bytes b) {
      if (const auto m = decode<insula_lcm::sim_event_t>(b)) {
        std::lock_guard lock(mutex_);
        events_.push_back(*m);
      }
    });
    bus_.subscribe(channel::haptic_status, [this](Bytes b) {
      if (const auto m = decode<insula_lcm::haptic_status_t>(b)) {
        std::lock_guard lock(mutex_);
        status_ = *m;
      }
    });
    thread_ = std::thread([this] {
      while (!stop_) bus_.poll(20);
    });
  }
  ~Watcher() {
    stop_ = true;
    thread_.join();
  }
  Watcher(const Watcher&) = delete;
  Watcher& operator=(const Watcher&) = delete;

  std::vector<Sample> samples() const {
    std::lock_guard lock(mutex_);
    return samples_;
  }
  std::optional<Sample> last() const {
    std::lock_guard lock(mutex_);
    return samples_.empty() ? std::nullopt : std::optional(samples_.back());
  }
  std::int64_t frame_session() const {
    std::lock_guard lock(mutex_);
    return frame_session_;
  }
  std::size_t frames(std::int64_t session) const {
    std::lock_guard lock(mutex_);
    const auto found = frames_.find(session);
    return found == frames_.end() ? 0 : found->second.size();
  }
  std::size_t frames_now() const { return frames(frame_session()); }
  insula_lcm::haptic_status_t status() const {
    std::lock_guard lock(mutex_);
    return status_;
  }
  LcmBus& out() { return out_; }
  /// States of the tools in the last frame.
  std::vector<int> tool_states() const {
    std::lock_guard lock(mutex_);
    return tool_states_;
  }
  std::vector<insula_lcm::sim_event_t> events() const {
    std::lock_guard lock(mutex_);
    return events_;
  }
  void ask(const std::string& command, const std::string& argument = "") {
    insula_lcm::user_command_t m{};
    m.time_us = now_us();
    m.sender = "test";
    m.command = command;
    m.argument = argument;
    publish(out_, channel::user_command, m, scratch_);
  }
  /// Asks again and again until an event of that kind says so; messages may be lost.
  bool asked(const std::string& command, const std::string& argument, const std::string& kind) {
    const std::size_t seen = events().size();
    return wait_for([&] {
      ask(command, argument);
      std::this_thread::sleep_for(100ms);
      const auto all = events();
      return std::any_of(all.begin() + std::ptrdiff_t(seen), all.end(), [&](const auto& e) { return e.kind == kind && e.id == command; });
    });
  }

  /// The largest force on a hand now, N.
  double force() const {
    const auto s = last();
    return s ? std::max(s->force[0].norm(), s->force[1].norm()) : 0;
  }

  /// Lowers both hands half a millimetre at a time until each feels at least `wanted` newtons.
  bool press(double wanted) {
    if (!wait_for([&] { return last().has_value(); })) return false;
    std::array<Vec3, 2> at = last()->position;
    for (int step = 0; step < 600; ++step) {
      bool enough = true;
      const auto now = last();
      for (int hand = 0; hand < 2; ++hand) {
        if (now->force[hand].norm() >= wanted) continue;
        enough = false;
        if (step % 4 == 0 && at[hand].z() > -0.02) at[hand].z() -= 0.0005;
        insula_lcm::hand_input_t m{};
        m.time_us = now_us();
        m.hand = std::int8_t(hand);
        for (int i = 0; i < 3; ++i) m.p_m[i] = at[hand][i];
        for (int i = 0; i < 4; ++i) m.q[i] = quaternion_[hand][i];
        publish(out_, channel::hand_input, m, scratch_);
      }
      if (enough) return true;
      std::this_thread::sleep_for(17ms);
    }
    return false;
  }

 private:
  void on_device(Bytes b) {
    const auto m = decode<insula_lcm::device_state_t>(b);
    if (!m || m->hands != 2) return;
    Sample s{m->session, m->sequence, m->time_us, {}, {}};
    std::lock_guard lock(mutex_);
    for (const auto& h : m->hand) {
      s.force[h.hand] = Vec3(h.force_N[0], h.force_N[1], h.force_N[2]);
      s.position[h.hand] = Vec3(h.p_m[0], h.p_m[1], h.p_m[2]);
      std::copy(h.q, h.q + 4, quaternion_[h.hand].begin());
    }
    samples_.push_back(s);
  }

  LcmBus bus_, out_;
  std::thread thread_;
  std::atomic<bool> stop_{false};
  mutable std::mutex mutex_;
  std::vector<Sample> samples_;
  std::map<std::int64_t, std::set<std::int64_t>> frames_;
  std::int64_t frame_session_ = 0;
  std::vector<int> tool_states_;
  std::vector<insula_lcm::sim_event_t> events_;
  insula_lcm::haptic_status_t status_{};
  std::array<std::array<double, 4>, 2> quaternion_{};
  std::vector<std::uint8_t> scratch_;
};

/// `insula play` of a small scene: two spatulas over a block of tissue.
class PlaySession {
 public:
  PlaySession() {
    std::string name = (fs::temp_directory_path() / "insula_play_XXXXXX").string();
    folder_ = ::mkdtemp(name.data());
    const fs::path meshes = fs::path(INSULA_SOURCE_DIR) / "meshes";
    fs::create_directories(folder_ / "meshes/instruments");
    fs::copy(meshes / "examples", folder_ / "meshes/examples", fs::copy_options::recursive);
    fs::copy(meshes / "instruments/retractor", folder_ / "meshes/instruments/retractor", fs::copy_options::recursive);
    std::ofstream(folder_ / "press.xml") << scene_text;
    url_ = own_bus_url();
    ::setenv("LCM_DEFAULT_URL", url_.c_str(), 1);
    // Also when the supervisor is killed and cannot clean up: what it leaves goes with the folder.
    ::setenv("XDG_RUNTIME_DIR", folder_.c_str(), 1);
    ::unsetenv("DISPLAY");
    ::unsetenv("WAYLAND_DISPLAY");
  }
  ~PlaySession() {
    end();
    fs::remove_all(folder_);
  }
  PlaySession(const PlaySession&) = delete;
  PlaySession& operator=(const PlaySession&) = delete;

  std::string start(const std::vector<std::string>& more = {}) {
    std::vector<std::string> command{std::string(INSULA_BINARY_DIR) + "/bin/insula", "play", (folder_ / "press.xml").string(),
                                     "--port", "0"};
    command.insert(command.end(), more.begin(), more.end());
    const std::string error = process_.start(command);
    reader_ = std::thread([this] {
      while (process_.output() >= 0 && !stop_) {
        process_.read_lines([this](std::string_view line) { on_line(std::string(line)); });
        std::this_thread::sleep_for(5ms);
      }
      // Its last words, written just before it ended.
      if (process_.output() >= 0) process_.read_lines([this](std::string_view line) { on_line(std::string(line)); });
    });
    return error;
  }
  /// Ctrl-C; returns how it ended.
  ChildExit end() {
    ChildExit result = last_exit_;
    if (process_.running()) {
      process_.send(SIGINT);
      std::optional<ChildExit> exit;
      wait_for([&] { return (exit = process_.reap()).has_value(); });
      if (exit) result = last_exit_ = *exit;
    }
    stop_ = true;
    if (reader_.joinable()) reader_.join();
    return result;
  }
  /// Waits for it to end by itself.
  std::optional<ChildExit> ended() {
    std::optional<ChildExit> exit;
    wait_for([&] { return (exit = process_.reap()).has_value(); });
    if (exit) last_exit_ = *exit;
    return exit;
  }

  pid_t pid(const std::string& child) const {
    std::lock_guard lock(mutex_);
    const auto found = pids_.find(child);
    return found == pids_.end() ? 0 : found->second;
  }
  int port() const {
    std::lock_guard lock(mutex_);
    return port_;
  }
  /// How often a line with this text was printed.
  int count(std::string_view text) const {
    std::lock_guard lock(mutex_);
    int n = 0;
    for (const auto& l : lines_) n += l.find(text) != std::string::npos;
    return n;
  }
  std::string log() const {
    std::lock_guard lock(mutex_);
    std::string out;
    for (const auto& l : lines_) out += l + "\n";
    return out;
  }
  void kill_child(const std::string& child) const {
    if (const pid_t p = pid(child); p > 0) ::kill(p, SIGKILL);
  }
  const std::string& url() const { return url_; }
  const fs::path& folder() const { return folder_; }
  pid_t supervisor() const { return process_.pid(); }

 private:
  static constexpr const char* scene_text = R"(<scene title="Press">
  <soft_body id="block" mesh="meshes/examples/block.msh" mesh_unit="mm">
    <corotational_fem/>
    <fixed region="beyond" centre="0 0 -19 mm" normal="0 0 -1"/>
    <surface/>
  </soft_body>
  <retractor id="left" model="meshes/instruments/retractor/retractor.urdf" hand="left"
             home="-5 0 3 mm" shaft="0 0 1" flat="1 0 0"/>
  <retractor id="right" model="meshes/instruments/retractor/retractor.urdf" hand="right"
             home="5 0 3 mm" shaft="0 0 1" flat="1 0 0"/>
  <retractor id="spare" model="meshes/instruments/retractor/retractor.urdf" hand="left"
             home="-5 0 3 mm" shaft="0 0 1" flat="1 0 0" coupling="1000 N/m"/>
  <contact between="left right spare block" friction="0.2"/>
</scene>
)";

  void on_line(const std::string& line) {
    std::lock_guard lock(mutex_);
    lines_.push_back(line);
    constexpr std::string_view head = "insula: ";
    if (!line.starts_with(head)) return;
    if (const std::size_t at = line.find(" started (pid "); at != std::string::npos)
      pids_[line.substr(head.size(), at - head.size())] = pid_t(std::atoi(line.c_str() + at + 14));
    if (line.find("viewer at ") != std::string::npos) port_ = std::atoi(line.c_str() + line.rfind(':') + 1);
  }

  fs::path folder_;
  std::string url_;
  ChildProcess process_;
  ChildExit last_exit_;
  std::thread reader_;
  std::atomic<bool> stop_{false};
  mutable std::mutex mutex_;
  std::vector<std::string> lines_;
  std::map<std::string, pid_t> pids_;
  int port_ = 0;
};

}  // namespace insula::testing
