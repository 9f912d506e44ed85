// SPDX-License-Identifier: GPL-3.0-or-later
// Data of the running scene for the server besides the problems: the scripted motion and the hands' home poses.
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
  /// Axes of the person at the screen (x right, y away, z up) in the scene: those of the microscope's image.
  Quat person_to_scene = Quat::Identity();
  double force_scale = 1;
  std::string problem;  ///< reason why motion or homes could not be read; empty: none
};

/// Reads the motion (`motion_file`, empty: none), the homes and the view from `bundle`/scene.json. Never throws. Parts
/// that cannot be read are left out and reported in `problem`.
SceneSetup read_scene_setup(std::int64_t session, const std::string& motion_file, const std::filesystem::path& bundle);

/// Passes setups from one thread to the servo without locks. The giving thread frees old ones.
class SetupExchange {
 public:
  /// Called by the giving thread.
  void give(std::unique_ptr<const SceneSetup> setup);
  /// Called by the servo thread: the newest setup, or nullptr. It is valid until the next take().
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
