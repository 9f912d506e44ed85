// SPDX-License-Identifier: GPL-3.0-or-later
// The vessel of a built case while an author moves it: `insula_case pose` as a program of its own, which answers one
// pose after the other. One case at a time. Used on the network thread.
#pragma once
#include <array>
#include <chrono>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>

#include "core/base/child_process.h"

namespace insula::gateway {

class StudioPoses {
 public:
  using Clock = std::chrono::steady_clock;
  using Pose = std::array<double, 6>;  ///< a shift in mm, a rotation vector in degrees
  struct Question {
    Pose pose;
    bool parted = false;  ///< with the lobes parted, which takes seconds
  };

  /// program: insula_case. idle: the program ends when nothing was asked for so long.
  explicit StudioPoses(std::filesystem::path program, Clock::duration idle = std::chrono::seconds(60));

  /// {state: "starting" | "ready" | "failed", error, busy, facts, answer}, as tools/case_builder/pose_view.h has facts
  /// and answer; the answer is the last one. A question that waits while another one is answered gives way to a newer
  /// one. surfaces: the folder that gets the surfaces.
  nlohmann::json ask(const std::filesystem::path& built, const std::filesystem::path& surfaces,
                     const std::optional<Question>& question);
  void look();
  /// Of the running program, or none.
  int pid() const { return child_.pid(); }

 private:
  void begin(const std::filesystem::path& built, const std::filesystem::path& surfaces);
  void hear(std::string_view line);
  void tell_next();

  std::filesystem::path program_, built_;
  Clock::duration idle_;
  Clock::time_point asked_at_{};
  ChildProcess child_;
  std::optional<Question> next_;
  bool busy_ = false;  ///< a question is being answered
  std::string error_;
  nlohmann::json facts_, answer_;
};

/// "1,2,3,0,0,90", a pose of a query; empty if it is none.
std::optional<StudioPoses::Pose> pose_of(const std::string& text);

}  // namespace insula::gateway
