// SPDX-License-Identifier: GPL-3.0-or-later
// What the server needs of the running scene besides its problems: the scripted motion and where the hands are at home.
#pragma once
#include <array>
#include <atomic>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include "core/sim/motion.h"

namespace insula {

struct SceneSetup {
  std::int64_t session = 0;
  Motion motion;  ///< empty: none
  std::array<bool, 2> has_home{false, false};
  std::array<Pose, 2> home;
  /// Axes of the person at the screen (x right, y away, z up) in the scene: those of the microscope's picture.
  Quat person_to_scene = Quat::Identity();
  double force_scale = 1;
  std::string problem;  ///< why motion or homes could not be read, empty when fine
};

/// Reads the motion (`motion_file`, empty: none), the homes and the view from `bundle`/scene.json. Never throws: what
/// cannot be read is left out and said in `problem`.
SceneSetup read_scene_setup(std::int64_t session, const std::string& motion_file, const std::filesystem::path& bundle);

/// Hands setups from one thread to the servo without locks; the old ones are freed on the giving side.
class SetupExchange {
 public:
  /// Giving thread.
  void give(std::unique_ptr<const SceneSetup> setup);
  /// Servo thread: the newest, or nullptr; stays valid until the next take().
  const SceneSetup* take() noexcept {
    const SceneSetup* s = next_.load(std::memory_order_acquire);
    in_use_.store(s, std::memory_order_release);
    return s;
  }

 private:
  std::vector<std::unique_ptr<const SceneSetup>> owned_;  // the last is the newest
  std::atomic<const SceneSetup*> next_{nullptr};
  std::atomic<const SceneSetup*> in_use_{nullptr};
};

}  // namespace insula
