// SPDX-License-Identifier: GPL-3.0-or-later
// The commands of a scripted motion, each executed at its time.
#pragma once
#include <cstddef>
#include <vector>

#include "core/sim/motion.h"
#include "core/sim/simulation.h"

namespace insula {

class CommandScript {
 public:
  explicit CommandScript(std::vector<MotionCommand> commands = {}) : commands_(std::move(commands)) {}

  void reset() { next_ = 0; }
  /// Called before a step: executes the commands that are due. Without `followed` (a person moves the hands) they are
  /// skipped.
  void advance(Simulation& simulation, bool followed = true) {
    for (; next_ < commands_.size() && commands_[next_].time_s <= simulation.time() + 1e-9; ++next_)
      if (followed) simulation.command(commands_[next_].verb, commands_[next_].argument);
  }

 private:
  std::vector<MotionCommand> commands_;
  std::size_t next_ = 0;
};

}  // namespace insula
