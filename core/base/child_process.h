// SPDX-License-Identifier: GPL-3.0-or-later
// A child process whose output is read line by line, and which may be told things. It does not outlive its parent.
// The implementation belongs to the operating system (platform/).
#pragma once
#include <functional>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace insula {

struct ChildExit {
  int status = 0;  ///< exit status, -1 when a signal ended it
  int signal = 0;
  std::string text() const;  ///< "ended with status 1", "was killed by signal 9 (Killed)"
};

class ChildProcess {
 public:
  using Line = std::function<void(std::string_view)>;

  ChildProcess() = default;
  ~ChildProcess();  ///< kills a process that still runs
  ChildProcess(const ChildProcess&) = delete;
  ChildProcess& operator=(const ChildProcess&) = delete;
  ChildProcess& operator=(ChildProcess&& other) noexcept;  ///< kills a process that still runs here

  /// What it reads: nothing, or what write() says.
  enum class Input { none, pipe };
  /// Starts command[0] with its arguments, in a process group of its own (a terminal's Ctrl-C reaches only the parent)
  /// and with SIGTERM on the parent's death. Returns the error text; empty when started. A program that cannot be
  /// executed ends with status 127.
  std::string start(const std::vector<std::string>& command, Input input = Input::none);
  bool running() const { return pid_ > 0; }
  int pid() const { return pid_; }
  int output() const { return output_; }  ///< descriptor to wait on, -1 when closed
  /// Passes on the complete lines that have arrived. Never waits.
  void read_lines(const Line& line);
  /// How it ended, once; nothing while it still runs. Never waits.
  std::optional<ChildExit> reap();
  /// After reap(): passes on the rest of its output, with a last unfinished line.
  void finish_output(const Line& line);
  void send(int signal) const;
  /// Gives it text to read. False if it has ended, reads nothing, or has not yet read what came before. Never waits.
  bool write(std::string_view text);

 private:
  void close_pipes();

  int pid_ = -1;
  int output_ = -1;
  int input_ = -1;
  std::string pending_;
};

}  // namespace insula
