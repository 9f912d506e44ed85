// SPDX-License-Identifier: GPL-3.0-or-later
// Two hands that are moved through a running simulation while their poses are written down as a motion.
#pragma once
#include <filesystem>
#include <string>
#include <vector>

#include "core/sim/simulation.h"

namespace insula {

struct Wish {
  Pose pose;
  bool button1 = false;
};

class Hands {
 public:
  explicit Hands(Simulation& simulation);
  /// Moves both hands from where they are, at rest at both ends (minimum jerk); the buttons change at the start.
  void move(double seconds, const Wish& left, const Wish& right);
  void move(double seconds, const Wish& right) { move(seconds, now_[0], right); }
  void wait(double seconds) { move(seconds, now_[0], now_[1]); }
  const Wish& left() const { return now_[0]; }
  const Wish& right() const { return now_[1]; }
  double time() const { return simulation_.time(); }
  Simulation& simulation() { return simulation_; }
  /// time_s,hand,... a key every third step and at the ends of moves.
  void write(const std::filesystem::path& file) const;

 private:
  void key();
  Simulation& simulation_;
  Wish now_[2];
  std::vector<std::string> rows_;
};

/// Pose of a tool whose tip is at p: +z along the shaft, +y in the blade's plane across the shaft.
Pose tool_pose(const Vec3& p, const Vec3& shaft, const Vec3& across);

}  // namespace insula
