// SPDX-License-Identifier: GPL-3.0-or-later
// A program that is asked something for the studio: it runs beside this one, and its answer is what it prints.
#pragma once
#include <chrono>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "core/base/child_process.h"

namespace insula::gateway {

class StudioQuestion {
 public:
  using Clock = std::chrono::steady_clock;
  /// limit: after it, the program is killed.
  StudioQuestion(const std::vector<std::string>& command, std::chrono::seconds limit);

  /// Reads what was said. Whether it has ended.
  bool look();
  bool ended() const { return ended_; }
  bool succeeded() const { return ended_ && error_.empty(); }
  /// Why it failed, for the author; empty while it runs, and after a success.
  const std::string& error() const { return error_; }
  /// What it printed, as JSON; discarded if it is none.
  nlohmann::json answer() const;
  /// Since its end.
  Clock::duration age() const { return Clock::now() - end_; }

 private:
  ChildProcess child_;
  Clock::time_point limit_, end_;
  std::string said_, error_;
  bool ended_ = false, late_ = false;
};

}  // namespace insula::gateway
