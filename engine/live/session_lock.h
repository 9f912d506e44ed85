// SPDX-License-Identifier: GPL-3.0-or-later
// One session on each bus: two engines on one bus would move the same hands. A session holds a lock file named by the
// bus, with the viewer's address in it for those who come later.
#pragma once
#include <filesystem>
#include <memory>
#include <string>

#include "core/bus/bus.h"

namespace insula {

/// The user's folder for files of running programs: XDG_RUNTIME_DIR, or else the folder for temporary files.
std::filesystem::path runtime_folder();

class SessionLock {
 public:
  SessionLock(std::filesystem::path folder, std::string bus_url);
  ~SessionLock();
  SessionLock(const SessionLock&) = delete;
  SessionLock& operator=(const SessionLock&) = delete;

  /// Takes the lock. False if another session of this user holds it. A machine where no file can be made has no lock,
  /// and the answer is true.
  bool take();
  /// Leaves the address of this session's viewer for those who come later.
  void announce(const std::string& viewer_url) const;
  /// The address of the viewer of the session that holds the lock; empty: not known.
  std::string viewer() const;

 private:
  std::filesystem::path file_;
  int descriptor_ = -1;
};

/// Listens for an engine that speaks on the bus, for example of another user. Engines repeat SCENE_INFO each second.
class EngineListener {
 public:
  explicit EngineListener(Bus& bus);
  /// Waits until `listened_s` after the construction at most. True if an engine was heard.
  bool heard(double listened_s = 1.3);

 private:
  struct State;
  Bus& bus_;
  std::shared_ptr<State> state_;
};

/// What to do when a session runs already on the bus: join it, or choose another bus.
std::string second_session_advice(const std::string& bus_url, const std::string& viewer_url);

}  // namespace insula
