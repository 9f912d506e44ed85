// SPDX-License-Identifier: GPL-3.0-or-later
// A real `insula play` with its three processes, on a bus of its own.
#pragma once
#include <gtest/gtest.h>
#include <signal.h>
#include <sys/wait.h>
#include <unistd.h>

#include <atomic>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <map>
#include <mutex>
#include <string>
#include <thread>
#include <vector>

#include "core/base/child_process.h"
#include "core/testing/multicast.h"
#include "tests/process/watcher.h"

namespace insula::testing {

namespace fs = std::filesystem;

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
    // If the supervisor is killed and cannot clean up, its files are removed with the folder.
    ::setenv("XDG_RUNTIME_DIR", folder_.c_str(), 1);
    ::setenv("HOME", folder_.c_str(), 1);  // reports that no test asks for
    ::unsetenv("XDG_DATA_HOME");           // recordings go below HOME
    ::unsetenv("DISPLAY");
    ::unsetenv("WAYLAND_DISPLAY");
  }
  ~PlaySession() {
    end();
    fs::remove_all(folder_);
  }
  PlaySession(const PlaySession&) = delete;
  PlaySession& operator=(const PlaySession&) = delete;

  /// scene: in place of the small one.
  std::string start(const std::vector<std::string>& more = {}, const fs::path& scene = {}) {
    std::vector<std::string> command{std::string(INSULA_BINARY_DIR) + "/bin/insula", "play",
                                     (scene.empty() ? folder_ / "press.xml" : scene).string(), "--port", "0"};
    command.insert(command.end(), more.begin(), more.end());
    const std::string error = process_.start(command);
    reader_ = std::thread([this] {
      while (process_.output() >= 0 && !stop_) {
        process_.read_lines([this](std::string_view line) { on_line(std::string(line)); });
        std::this_thread::sleep_for(5ms);
      }
      // Its last output, written just before it ended.
      if (process_.output() >= 0) process_.read_lines([this](std::string_view line) { on_line(std::string(line)); });
    });
    return error;
  }
  /// Sends Ctrl-C and returns how it ended.
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
  /// Number of printed lines that contain this text.
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
