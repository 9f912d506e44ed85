// SPDX-License-Identifier: GPL-3.0-or-later
// One program at work for a project of the case builder's page: what it says, how far it is, and how it ended.
#pragma once
#include <chrono>
#include <string>
#include <vector>

#include "core/base/child_process.h"

namespace insula::gateway {

class StudioJob {
 public:
  using Clock = std::chrono::steady_clock;
  enum class Kind { scan, inspect, build, add, trial };
  /// limit: after it, the program is ended.
  StudioJob(Kind kind, const std::vector<std::string>& command, std::chrono::seconds limit);

  Kind kind() const { return kind_; }
  /// Reads what was said. Whether it has ended.
  bool look();
  void cancel();

  bool cancelled() const { return cancelled_; }
  /// The program itself said why not.
  bool refused() const { return ended_ && tells_error_ && !cancelled_; }
  bool succeeded() const { return ended_ && error_.empty(); }
  /// For the author; empty while it runs, and after a success.
  const std::string& error() const { return error_; }
  const std::string& stage() const { return stage_; }
  const std::string& step() const { return step_; }
  int percent() const { return percent_; }
  double seconds() const { return std::chrono::duration<double>(Clock::now() - began_).count(); }

 private:
  void hear(std::string_view line);
  void end(const ChildExit& exit);

  Kind kind_;
  ChildProcess child_;
  Clock::time_point began_ = Clock::now(), limit_, kill_at_ = Clock::time_point::max();
  std::string stage_, step_, said_, error_;
  int percent_ = 0;
  bool cancelled_ = false, late_ = false, ended_ = false, tells_error_ = false;
};

}  // namespace insula::gateway
