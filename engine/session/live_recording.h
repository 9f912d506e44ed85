// SPDX-License-Identifier: GPL-3.0-or-later
// The recording of a session that people play, in a new file. A session without a step leaves none.
#pragma once
#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include "engine/session/session_recorder.h"

namespace insula {

/// `wanted` if it ends in .insula, else a name in that folder made of date, time and the scene's name. A number is
/// added if the file exists. Creates the folder and the empty file, so that two sessions never have the same one.
/// Throws InputError if it cannot.
std::filesystem::path new_session_file(const std::filesystem::path& wanted, const std::filesystem::path& scene);

class LiveRecording {
 public:
  /// wanted: as for new_session_file(); empty: nothing is recorded. A failure goes to the log, and the session
  /// continues.
  LiveRecording(const std::filesystem::path& wanted, const Simulation& simulation, const SessionAbout& about);
  /// After each step.
  void step(const Simulation& simulation);
  /// Before a reset.
  void end_pass(const Simulation& simulation);
  /// Events that belong to no step.
  void note(const std::vector<Event>& events);
  /// What was found of a pass that has ended (SessionRecorder::review()).
  void review(const std::string& json);
  /// Number of the present pass, from 1; 0: nothing is recorded.
  int pass() const { return recorder_ ? recorder_->pass() : 0; }
  /// A message on both hands (SessionRecorder::hands()).
  void hands(mcap::Bytes device_state);
  /// A message on the servo's ticks (SessionRecorder::ticks()).
  void ticks(mcap::Bytes servo_ticks);
  /// At the end of the session.
  void close(const Simulation& simulation);

  /// The file that is being written; empty: none, or no longer.
  std::string file() const;
  /// Why nothing is recorded although it should be; empty: all is well.
  std::string failure() const;

 private:
  std::unique_ptr<SessionRecorder> recorder_;
  std::string failure_;
  bool stepped_ = false;
};

}  // namespace insula
