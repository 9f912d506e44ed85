// SPDX-License-Identifier: GPL-3.0-or-later
// The reports of a session that people play: one for each pass through the exercise. A pass lasts from the start or a
// reset to the exercise's end, the next reset or the session's end, whichever is first. Later steps are not in the
// report.
#pragma once
#include <array>
#include <ctime>
#include <filesystem>
#include <future>
#include <insula_lcm/device_state_t.hpp>
#include <insula_lcm/haptic_status_t.hpp>
#include <map>
#include <memory>
#include <mutex>
#include <string>
#include <vector>

#include "core/sim/simulation.h"
#include "engine/live/session_mode.h"
#include "engine/reports/report_writer.h"

namespace insula {

/// Creates a new folder `name` in `root`, or `name`_2, `name`_3, ... if it exists. Also creates `root`. Throws
/// InputError if it cannot.
std::filesystem::path new_report_folder(const std::filesystem::path& root, const std::string& name);

/// Reports are written in a thread of their own, since they take longer than a hand may be without a new problem. A
/// failure to write goes to the log, and the session continues.
class SessionReports {
 public:
  /// root: each report gets a folder there, named by date, time and scene; empty: none are written. motion: that of
  /// simulated hands. fields: RunSummary::fields.
  SessionReports(std::filesystem::path root, std::filesystem::path scene, std::string motion,
                 std::map<std::string, std::string> fields = {});

  /// Of the reports from now on.
  void compare_with(ReferenceBands bands) { bands_ = std::move(bands); }
  /// Each run is also kept in this training store, which is created if it is missing. Empty: in none.
  void keep_in(std::filesystem::path store) { store_ = std::move(store); }
  /// Takes the haptic server's messages. The report uses the largest force between two steps, and the mean rate of
  /// fresh forces over the seconds in which a hand had any.
  void hear(const insula_lcm::device_state_t& hands);
  void hear(const insula_lcm::haptic_status_t& status);

  /// Called after a step. Allocates only for events. touched: the step's hands are those of the last messages.
  /// followed: they are simulated and follow the motion.
  void step(const Simulation& simulation, bool touched, bool followed);
  /// Takes events that belong to no step, for example while paused.
  void note(const std::vector<Event>& events);
  /// Called before a reset and at the end of the session. Writes a report if there is none yet, then begins a new one.
  void end_run(const Simulation& simulation);
  /// Begins a new one without a report of what was before.
  void begin();
  /// The file that the session is recorded into; empty: none.
  void set_recording(std::string file) { recording_ = std::move(file); }
  /// Number of the present pass in the recording; a review says to which pass it belongs.
  void set_recorded_pass(int pass) { recorded_pass_ = pass; }
  /// Of the passes that begin from now on.
  void set_mode(SessionMode mode) { mode_ = mode; }
  /// Absolute path of the report of this pass; empty until it is written.
  std::string last_report() const;
  /// Reviews of the reports written since the last call, for the recording: {pass, review} as JSON (review.h).
  std::vector<std::string> take_reviews();
  /// Until the report that is being written is there.
  void wait();

 private:
  /// Shared with the thread that writes.
  struct Written {
    std::mutex mutex;
    std::string path;
    std::vector<std::string> reviews;
    std::int64_t pass = 0;
  };

  void write(const Simulation& simulation);
  double fresh_forces_per_s() const;

  struct Hands {
    std::array<double, 2> force_N{}, largest_N{};  // last received; largest since the last step
    std::array<double, 2> fresh{};                 // sum of the rates
    std::array<int, 2> seconds{};                  // number of rates
  };

  std::filesystem::path root_, scene_, store_;
  std::string motion_, recording_;
  std::map<std::string, std::string> fields_;
  ReferenceBands bands_;
  RunRecorder recorder_;
  RunSummary summary_;
  Hands hands_;
  std::shared_ptr<Written> done_ = std::make_shared<Written>();
  SessionMode mode_ = SessionMode::practice;
  std::time_t began_ = 0;
  bool written_ = false, followed_ = false;
  int recorded_pass_ = 0;
  std::future<void> writing_;  // the destructor waits for it
};

}  // namespace insula
