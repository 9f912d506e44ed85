// SPDX-License-Identifier: GPL-3.0-or-later
// A recorded session: what it says of itself, its steps and events.
#pragma once
#include <array>
#include <functional>
#include <insula_lcm/servo_ticks_t.hpp>
#include <insula_lcm/session_step_t.hpp>
#include <insula_lcm/sim_event_t.hpp>
#include <optional>
#include <vector>

#include "core/container/mcap_reader.h"
#include "core/sim/input.h"

namespace insula {

class SessionReader {
 public:
  /// Throws InputError if the file is no session, or is damaged where it says what was recorded.
  explicit SessionReader(const std::filesystem::path& file);

  /// A value of the session's description; empty if it has none.
  std::string about(const std::string& key) const;
  /// What the person said of the session ("person", "level"), else the value of that key; empty: neither.
  std::string field(const std::string& name) const;
  /// Time step, s; 0 if the recording does not say it.
  double step_s() const;
  McapReader& container() { return file_; }
  /// All whole steps in order, until `take` returns false. Steps that are no valid messages are counted in damaged().
  void steps(const std::function<bool(const insula_lcm::session_step_t&)>& take);
  void events(const std::function<bool(const insula_lcm::sim_event_t&)>& take);
  /// Messages on every tick of the servo, with the simulated time of the recording, s, at which each came.
  void ticks(const std::function<bool(double, const insula_lcm::servo_ticks_t&)>& take);
  /// The metrics of a moment, as recorded.
  struct Metrics {
    std::int64_t number = 0;  ///< of the step
    int pass = 0;             ///< through the exercise, from 1
    double time_s = 0;        ///< of the pass
    std::string mode, state;  ///< state: "running", "done", "failed"
    bool last_of_pass = false;
    struct Value {
      std::string id, hand, unit, better;
      double value = 0;
    };
    std::vector<Value> values;
  };
  void metrics(const std::function<bool(const Metrics&)>& take);
  /// Those with which each pass ended, in order: at the exercise's end, else the last ones. What happens after the end
  /// does not count, as in reports.
  std::vector<Metrics> passes();
  /// The largest force that was sent to each hand, N, before the step of each number from 0; for sessions of persons.
  std::vector<std::array<double, 2>> hand_forces();
  /// Messages that were whole in the file and are not valid.
  std::int64_t damaged() const { return damaged_; }

 private:
  McapReader file_;
  std::int64_t damaged_ = 0;
};

/// What Simulation::give() takes.
SimulationInput input_of(const insula_lcm::step_input_t& message);

}  // namespace insula
