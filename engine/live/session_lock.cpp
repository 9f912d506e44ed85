// SPDX-License-Identifier: GPL-3.0-or-later
#include "engine/live/session_lock.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/file.h>
#include <unistd.h>

#include <chrono>
#include <cstdlib>
#include <insula_lcm/scene_info_t.hpp>

#include "core/bus/channels.h"
#include "core/bus/codec.h"

namespace fs = std::filesystem;

namespace insula {
namespace {

/// FNV-1a: the same name for the same address in every program.
std::uint64_t hash_of(const std::string& text) {
  std::uint64_t h = 14695981039346656037ull;
  for (const char c : text) h = (h ^ std::uint8_t(c)) * 1099511628211ull;
  return h;
}

/// The same address with the next port: "udpm://239.255.76.67:7667?ttl=0" -> "udpm://239.255.76.67:7668?ttl=0".
std::string next_bus(const std::string& url) {
  const std::size_t scheme = url.find("://"), colon = url.find(':', scheme == std::string::npos ? 0 : scheme + 3);
  const int port = colon == std::string::npos ? 0 : std::atoi(url.c_str() + colon + 1);
  if (port <= 0 || port >= 65535) return "udpm://239.255.76.67:7668?ttl=0";
  const std::size_t end = url.find_first_not_of("0123456789", colon + 1);
  return url.substr(0, colon + 1) + std::to_string(port + 1) + (end == std::string::npos ? "" : url.substr(end));
}

}  // namespace

fs::path runtime_folder() {
  const char* runtime = std::getenv("XDG_RUNTIME_DIR");
  std::error_code error;
  const bool usable = runtime != nullptr && *runtime != '\0' && fs::is_directory(runtime, error);
  return usable ? fs::path(runtime) : fs::temp_directory_path(error);
}

SessionLock::SessionLock(fs::path folder, std::string bus_url)
    : file_(std::move(folder) / fmt::format("insula-{}-{:016x}.session", getuid(), hash_of(bus_url))) {}

SessionLock::~SessionLock() {
  // The file stays: who removed it could remove the lock of a session that has just started.
  if (descriptor_ < 0) return;
  if (::ftruncate(descriptor_, 0) != 0) {
  }
  ::close(descriptor_);
}

bool SessionLock::take() {
  const int descriptor = ::open(file_.c_str(), O_RDWR | O_CREAT | O_CLOEXEC | O_NOFOLLOW, 0600);
  if (descriptor < 0) return true;
  if (::flock(descriptor, LOCK_EX | LOCK_NB) != 0) {
    ::close(descriptor);
    return false;
  }
  descriptor_ = descriptor;
  return ::ftruncate(descriptor_, 0) == 0;
}

void SessionLock::announce(const std::string& viewer_url) const {
  if (descriptor_ < 0 || ::ftruncate(descriptor_, 0) != 0) return;
  // Without the address a second session still stops, and says less.
  if (::pwrite(descriptor_, viewer_url.data(), viewer_url.size(), 0) < 0) return;
}

std::string SessionLock::viewer() const {
  const int descriptor = ::open(file_.c_str(), O_RDONLY | O_CLOEXEC | O_NOFOLLOW);
  if (descriptor < 0) return {};
  char text[512];
  const ssize_t size = ::read(descriptor, text, sizeof text);
  ::close(descriptor);
  return size > 0 ? std::string(text, std::size_t(size)) : std::string();
}

struct EngineListener::State {
  std::chrono::steady_clock::time_point began = std::chrono::steady_clock::now();
  bool heard = false;
};

EngineListener::EngineListener(Bus& bus) : bus_(bus), state_(std::make_shared<State>()) {
  bus_.subscribe(channel::scene_info, [state = state_](Bytes b) {
    std::string why;
    insula_lcm::scene_info_t info{};
    if (decode(b, info, why) && info.state != "ended") state->heard = true;
  });
}

bool EngineListener::heard(double listened_s) {
  const auto end = state_->began + std::chrono::duration<double>(listened_s);
  do {
    bus_.poll(20);
  } while (!state_->heard && std::chrono::steady_clock::now() < end);
  return state_->heard;
}

std::string second_session_advice(const std::string& bus_url, const std::string& viewer_url) {
  std::string out = fmt::format("error: a session runs on this bus already ({})\n", bus_url);
  out += viewer_url.empty()
             ? "  to join it, open the address of its viewer, which it printed at its start\n"
             : fmt::format("  to join it, open {0} (as an instructor {0}?role=instructor)\n", viewer_url);
  out += fmt::format(
      "  to play a second session beside it, choose another bus: LCM_DEFAULT_URL=\"{}\" and another --port\n",
      next_bus(bus_url));
  return out;
}

}  // namespace insula
