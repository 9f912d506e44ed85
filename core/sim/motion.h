// SPDX-License-Identifier: GPL-3.0-or-later
// A scripted two-hand motion: poses of the hands over time, read from CSV.
#pragma once
#include <array>
#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include "core/base/math.h"

namespace insula {

/// State of a hand at one moment: device pose in the scene frame (m) and the device's two buttons.
struct HandSample {
  Pose pose;
  bool button1 = false;
  bool button2 = false;
};

/// Most bytes of a command's argument, from a motion or from people.
inline constexpr std::size_t longest_argument = 400;

/// A command at one moment of a motion: Simulation::command(verb, argument).
struct MotionCommand {
  double time_s = 0;
  std::string verb;      ///< "exchange", "ask", "message"
  std::string argument;  ///< "right applier"
};

/// Keys of both hands in rising time. Positions are interpolated linearly, rotations by slerp along the shorter arc.
/// Buttons keep the value of the last key. Before its first key and after its last one a hand stays there.
class Motion {
 public:
  struct Key {
    double time_s = 0;
    HandSample sample;
  };

  /// Appends a key; its time must be later than that hand's last key. hand: 0 left, 1 right. Throws InputError
  /// otherwise.
  void add(int hand, const Key& key);

  bool has(int hand) const { return hand >= 0 && hand < 2 && !keys_[std::size_t(hand)].empty(); }
  bool empty() const { return !has(0) && !has(1) && commands_.empty(); }
  /// State of the hand at t (s). A hand without keys gives the identity pose. Neither allocates nor throws.
  HandSample at(int hand, double t) const noexcept;
  /// Commands in the order of their times; commands of the same time in the order in which they were added.
  const std::vector<MotionCommand>& commands() const { return commands_; }
  void add(MotionCommand command);
  /// Time of the latest key or command, 0 when empty.
  double duration() const;
  /// Corners of the box that holds all positions of a hand; false when it has none.
  bool bounds(int hand, Vec3& low, Vec3& high) const;
  const std::vector<Key>& keys(int hand) const { return keys_[std::size_t(hand)]; }

 private:
  std::array<std::vector<Key>, 2> keys_;
  std::vector<MotionCommand> commands_;
};

/// Reads `time_s,hand,px_m,py_m,pz_m,qw,qx,qy,qz,button1,button2` (the header line is required; hand is left or right;
/// buttons are 0 or 1). A row `time_s,command,verb,argument` is a command at that time. The argument is the rest of the
/// line, or is in double quotes (a quote inside is written twice). Command rows may be anywhere below the header.
/// Throws InputError "file:line: error: text" at the first wrong line.
Motion load_motion(const std::filesystem::path& path);
/// The same from text; `name` is used for the file in messages.
Motion parse_motion(std::string_view text, std::string_view name);

}  // namespace insula
