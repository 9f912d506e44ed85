// SPDX-License-Identifier: GPL-3.0-or-later
// The reports of a session that people play: one for each time the exercise is gone through, from the start or a reset
// to the exercise's end, the next reset or the session's end, whichever comes first. What comes after the exercise's
// end is not in it.
#pragma once
#include <array>
#include <ctime>
#include <filesystem>
#include <future>
#include <insula_lcm/device_state_t.hpp>
#include <insula_lcm/haptic_status_t.hpp>
#include <string>

#include "core/sim/simulation.h"
#include "engine/reports/report_writer.h"

namespace insula {

/// A folder that was not there before, and now is: `name` in `root`, which is made as well, or `name`_2, `name`_3, ...
/// Throws InputError when it cannot be made.
std::filesystem::path new_report_folder(const std::filesystem::path& root, const std::string& name);

/// Written beside the steps: reports take longer than a hand may be without a new problem. What cannot be written is
/// said in the log, and the session goes on.
class SessionReports {
 public:
  /// root: each report gets a folder there, named by date, time and scene; empty: none are written. motion: what
  /// simulated hands follow.
  SessionReports(std::filesystem::path root, std::filesystem::path scene, std::string motion);

  /// What the haptic server says of its hands: the largest force between two steps counts, and the mean rate of fresh
  /// forces over the seconds in which a hand had any.
  void hear(const insula_lcm::device_state_t& hands);
  void hear(const insula_lcm::haptic_status_t& status);

  /// After a step; allocates nothing but for events. touched: its hands are those heard of last. followed: they are
  /// simulated and do what the motion says.
  void step(const Simulation& simulation, bool touched, bool followed);
  /// Events of no step, as while paused.
  void note(const std::vector<Event>& events);
  /// Before a reset, and at the end of the session: writes what has no report yet, then begins anew.
  void end_run(const Simulation& simulation);

 private:
  void write(const Simulation& simulation);
  double fresh_forces_per_s() const;

  struct Hands {
    std::array<double, 2> force_N{}, largest_N{};  // last heard; largest since the last step
    std::array<double, 2> fresh{};                 // sum of the rates
    std::array<int, 2> seconds{};                  // and how many they were
  };

  std::filesystem::path root_, scene_;
  std::string motion_;
  RunRecorder recorder_;
  RunSummary summary_;
  Hands hands_;
  std::time_t began_ = 0;
  bool written_ = false, followed_ = false;
  std::future<void> writing_;  // its end is waited for here
};

}  // namespace insula
