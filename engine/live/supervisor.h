// SPDX-License-Identifier: GPL-3.0-or-later
// Supervises the processes of a session: starts them, passes on their output, restarts any that dies, and ends all
// together.
#pragma once
#include <chrono>
#include <functional>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "core/base/child_process.h"

namespace insula {

struct SupervisorSettings {
  double first_wait_s = 0.2;  ///< before a dead child is started again; doubles while it keeps dying early
  double longest_wait_s = 2;
  double settled_s = 5;             ///< a child that lived this long starts over with first_wait_s
  double patience_s = 3;            ///< from SIGTERM to SIGKILL when ending
  double duration_s = 0;            ///< ends by itself after this time; 0: never
  std::function<void()> look = {};  ///< called every look_s while the session runs
  double look_s = 0.1;
};

struct ChildSpec {
  std::string name;
  std::vector<std::string> command;  ///< program (a path) and arguments
  bool ends_session = false;         ///< if it ends with status 0, the session ends
  bool waits_for_offer = false;  ///< if it has run before and ends because of bad input (status 2), it stays away until
                                 ///< there is another offer
  bool may_stay_away = false;    ///< if it cannot go on (status 2, or 100 and more), the session goes on without it
  /// Gets each line of output, and may change the command for the next start. Returns false if the line shall not be
  /// shown.
  std::function<bool(ChildSpec&, std::string_view)> on_line;
};

class Supervisor {
 public:
  using Print = std::function<void(std::string_view)>;  ///< one line, without its end
  Supervisor(SupervisorSettings settings, Print print);
  ~Supervisor();

  void add(ChildSpec spec);
  /// Another command for a child. It is started beside the running one. It takes over when it has printed the line
  /// `ready_line`. The old process is then ended, and the new one gets SIGUSR1 once the old one is gone. If the new
  /// process ends earlier, the old one continues, and `refused` gets what the new one printed. A second offer replaces
  /// a first one that is not ready.
  struct Offer {
    std::vector<std::string> command;
    std::vector<std::string> command_after;  ///< starts the child again if it dies later; empty: that of the old one
    std::string ready_line;
    std::function<void(const std::vector<std::string>& lines, const ChildExit& exit)> refused;
    std::function<void()> taken;
  };
  /// False while an earlier offer is taking over. The caller then repeats it a moment later.
  bool offer(const std::string& name, Offer offer);
  /// Runs until SIGINT, SIGTERM or SIGHUP, the end of the duration, or the exit of a child that ends the session.
  /// Status 0; 2 if a child reports bad input (status 2); 1 if a program cannot be run or refuses its arguments (status
  /// 100 and more), unless it may stay away. Must be called on the main thread, since children die with the thread that
  /// started them.
  int run();

 private:
  using Clock = std::chrono::steady_clock;
  struct Child;
  void start(Child& child);
  void pass_on(Child& child, bool rest);
  void collect();
  void after_exit(Child& child, const ChildExit& exit);
  void collect_offer(Child& child);
  void end_all(int status);
  int wait_ms() const;
  void wait(int signal_descriptor);

  SupervisorSettings settings_;
  Print print_;
  std::vector<std::unique_ptr<Child>> children_;  // in the order of starting
  bool ending_ = false;
  int status_ = 0;
  Clock::time_point began_, kill_at_;
};

/// Why an offer of an engine was refused: the errors and warnings among its lines, one a line, else how it ended.
std::string why_refused(const std::vector<std::string>& lines, const ChildExit& exit);

}  // namespace insula
