// SPDX-License-Identifier: GPL-3.0-or-later
// fork, exec, pipes and waits.
#include "core/base/child_process.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <signal.h>
#include <sys/prctl.h>
#include <sys/socket.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cerrno>
#include <cstdlib>
#include <cstring>
#include <utility>

namespace insula {
namespace {

constexpr std::size_t longest_line = 16 * 1024;

/// Runs in the child between fork and exec, so it must not allocate or lock.
[[noreturn]] void become(char* const* arguments, int input, int output, pid_t parent) {
  prctl(PR_SET_PDEATHSIG, SIGTERM);
  if (getppid() != parent) _exit(1);  // the parent died before prctl
  setpgid(0, 0);
  for (int s : {SIGINT, SIGTERM, SIGHUP, SIGCHLD, SIGPIPE}) signal(s, SIG_DFL);
  sigset_t none;
  sigemptyset(&none);
  sigprocmask(SIG_SETMASK, &none, nullptr);
  dup2(input >= 0 ? input : open("/dev/null", O_RDONLY), STDIN_FILENO);
  dup2(output, STDOUT_FILENO);
  dup2(output, STDERR_FILENO);
  execv(arguments[0], arguments);
  static constexpr char message[] = "cannot execute the program\n";
  [[maybe_unused]] const auto written = ::write(STDERR_FILENO, message, sizeof message - 1);
  _exit(127);
}

}  // namespace

std::string ChildExit::text() const {
  return signal != 0 ? fmt::format("was ended by signal {} ({})", signal, strsignal(signal))
                     : fmt::format("ended with status {}", status);
}

ChildProcess::~ChildProcess() {
  if (running()) {
    send(SIGKILL);
    waitpid(pid_, nullptr, 0);
  }
  close_pipes();
}

ChildProcess& ChildProcess::operator=(ChildProcess&& other) noexcept {
  if (this == &other) return *this;
  if (running()) {
    send(SIGKILL);
    waitpid(pid_, nullptr, 0);
  }
  close_pipes();
  pid_ = std::exchange(other.pid_, -1);
  output_ = std::exchange(other.output_, -1);
  input_ = std::exchange(other.input_, -1);
  pending_ = std::move(other.pending_);
  return *this;
}

std::string ChildProcess::start(const std::vector<std::string>& command, Input input) {
  int pipe_ends[2], input_ends[2] = {-1, -1};  // of a socket, since a write to a pipe could raise SIGPIPE
  if (pipe2(pipe_ends, O_CLOEXEC) != 0) return fmt::format("pipe: {}", std::strerror(errno));
  if (input == Input::pipe && socketpair(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC, 0, input_ends) != 0) {
    const int why = errno;
    for (const int end : pipe_ends) close(end);
    return fmt::format("socketpair: {}", std::strerror(why));
  }
  std::vector<char*> arguments;
  for (const std::string& a : command) arguments.push_back(const_cast<char*>(a.c_str()));
  arguments.push_back(nullptr);
  const pid_t parent = getpid();
  // Signals are blocked during the fork, since the parent's handlers must not run in the child.
  sigset_t all, before;
  sigfillset(&all);
  sigprocmask(SIG_SETMASK, &all, &before);
  const pid_t pid = fork();
  if (pid == 0) become(arguments.data(), input_ends[1], pipe_ends[1], parent);
  sigprocmask(SIG_SETMASK, &before, nullptr);
  const int fork_error = errno;
  close(pipe_ends[1]);
  if (input_ends[1] >= 0) close(input_ends[1]);
  close_pipes();
  output_ = pipe_ends[0];
  input_ = input_ends[0];
  if (pid < 0) {
    close_pipes();
    return fmt::format("fork: {}", std::strerror(fork_error));
  }
  pid_ = pid;
  fcntl(output_, F_SETFL, O_NONBLOCK);
  pending_.clear();
  return {};
}

void ChildProcess::read_lines(const Line& line) {
  char buffer[4096];
  while (output_ >= 0) {
    const ssize_t n = read(output_, buffer, sizeof buffer);
    if (n < 0 && errno == EINTR) continue;
    if (n < 0) break;  // no more data now
    if (n == 0) {
      close_pipes();
      break;
    }
    pending_.append(buffer, std::size_t(n));
    std::size_t from = 0;
    for (std::size_t end; (end = pending_.find('\n', from)) != std::string::npos; from = end + 1)
      line(std::string_view(pending_).substr(from, end - from));
    pending_.erase(0, from);
    if (pending_.size() > longest_line) {
      line(pending_);
      pending_.clear();
    }
  }
}

std::optional<ChildExit> ChildProcess::reap() {
  if (!running()) return std::nullopt;
  int status = 0;
  if (waitpid(pid_, &status, WNOHANG) != pid_) return std::nullopt;
  pid_ = -1;
  if (WIFSIGNALED(status)) return ChildExit{-1, WTERMSIG(status)};
  return ChildExit{WEXITSTATUS(status), 0};
}

void ChildProcess::finish_output(const Line& line) {
  read_lines(line);
  if (!pending_.empty()) line(pending_);
  pending_.clear();
  close_pipes();
}

void ChildProcess::send(int signal) const {
  if (running()) kill(pid_, signal);
}

bool ChildProcess::write(std::string_view text) {
  return input_ >= 0 && ::send(input_, text.data(), text.size(), MSG_NOSIGNAL | MSG_DONTWAIT) == ssize_t(text.size());
}

void ChildProcess::close_pipes() {
  for (int* end : {&output_, &input_}) {
    if (*end >= 0) close(*end);
    *end = -1;
  }
}

}  // namespace insula
