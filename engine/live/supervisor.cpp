// SPDX-License-Identifier: GPL-3.0-or-later
// One loop for signals, output and due restarts.
#include "engine/live/supervisor.h"

#include <fmt/format.h>
#include <poll.h>
#include <signal.h>

#include <algorithm>
#include <optional>

#include "core/base/signal_pipe.h"

namespace insula {
namespace {

std::chrono::nanoseconds seconds(double s) { return std::chrono::nanoseconds(std::int64_t(s * 1e9)); }

}  // namespace

struct Supervisor::Child {
  ChildSpec spec;
  ChildProcess process;
  double wait_s = 0;
  int starts = 0;
  Clock::time_point started{};
  std::optional<Clock::time_point> due;  // start at this time
  struct Next {
    Offer offer;
    ChildProcess process;
    std::vector<std::string> lines;
    bool ready = false, asked = false;  // has printed ready_line; the running one was asked to end
    Clock::time_point kill_at{};
  };
  std::unique_ptr<Next> next;  // the process that may replace it
};

Supervisor::Supervisor(SupervisorSettings settings, Print print) : settings_(settings), print_(std::move(print)) {}
Supervisor::~Supervisor() = default;

void Supervisor::add(ChildSpec spec) {
  auto child = std::make_unique<Child>();
  child->spec = std::move(spec);
  child->wait_s = settings_.first_wait_s;
  children_.push_back(std::move(child));
}

bool Supervisor::offer(const std::string& name, Offer given) {
  for (auto& child : children_) {
    if (child->spec.name != name || ending_) continue;
    if (child->next && child->next->asked) return false;
    child->next = std::make_unique<Child::Next>();
    child->next->offer = std::move(given);
    if (const std::string error = child->next->process.start(child->next->offer.command); !error.empty()) {
      print_(fmt::format("insula: cannot start {}: {}", name, error));
      child->next.reset();
    }
    break;
  }
  return true;
}

void Supervisor::collect_offer(Child& child) {
  if (!child.next) return;
  Child::Next& next = *child.next;
  const auto line = [&](std::string_view text) {
    if (text == next.offer.ready_line) next.ready = true;
    else if (next.lines.size() < 1000) next.lines.emplace_back(text);
  };
  next.process.read_lines(line);
  if (const auto exit = next.process.reap()) {
    next.process.finish_output(line);
    const auto gone = std::move(child.next);
    if (gone->asked && !child.process.running()) child.due = Clock::now();  // the old one has already ended
    if (!ending_ && gone->offer.refused) gone->offer.refused(gone->lines, *exit);
    return;
  }
  if (!next.ready || ending_) return;
  const auto now = Clock::now();
  if (child.process.running()) {
    if (!next.asked) {
      next.asked = true;
      next.kill_at = now + seconds(settings_.patience_s);
      child.process.send(SIGTERM);
    } else if (now >= next.kill_at) {
      child.process.send(SIGKILL);
    }
    return;
  }
  const auto taken = std::move(child.next);
  child.process = std::move(taken->process);
  child.process.send(SIGUSR1);
  if (!taken->offer.command_after.empty()) child.spec.command = taken->offer.command_after;
  child.due.reset();
  child.started = now;
  child.wait_s = settings_.first_wait_s;
  for (const std::string& l : taken->lines) print_(fmt::format("[{}] {}", child.spec.name, l));
  print_(fmt::format("insula: {} taken over (pid {})", child.spec.name, child.process.pid()));
  if (taken->offer.taken) taken->offer.taken();
}

void Supervisor::start(Child& child) {
  child.due.reset();
  child.started = Clock::now();
  ++child.starts;
  if (const std::string error = child.process.start(child.spec.command); !error.empty()) {
    print_(fmt::format("insula: cannot start {}: {}", child.spec.name, error));
    child.due = Clock::now() + seconds(settings_.longest_wait_s);
    return;
  }
  print_(fmt::format("insula: {} started (pid {})", child.spec.name, child.process.pid()));
}

void Supervisor::pass_on(Child& child, bool rest) {
  const auto line = [&](std::string_view text) {
    if (!child.spec.on_line || child.spec.on_line(child.spec, text))
      print_(fmt::format("[{}] {}", child.spec.name, text));
  };
  if (rest) child.process.finish_output(line);
  else child.process.read_lines(line);
}

void Supervisor::collect() {
  for (auto& child : children_) {
    pass_on(*child, false);
    if (const auto exit = child->process.reap()) {
      pass_on(*child, true);
      if (!(child->next && child->next->asked)) after_exit(*child, *exit);
    }
    collect_offer(*child);
  }
}

void Supervisor::after_exit(Child& child, const ChildExit& exit) {
  if (ending_) return;
  if (exit.status == 0 && child.spec.ends_session) return end_all(0);
  if (exit.status == 2 && child.spec.waits_for_offer && child.starts > 1) {
    print_(fmt::format("insula: {} {}; it waits for the next save", child.spec.name, exit.text()));
    return;
  }
  if (child.spec.may_stay_away && (exit.status == 2 || exit.status >= 100)) {
    print_(fmt::format("insula: {} {}; the session goes on without it", child.spec.name, exit.text()));
    return;
  }
  if (exit.status == 2 || exit.status >= 100) {
    print_(fmt::format("insula: {} {}; ending", child.spec.name, exit.text()));
    return end_all(exit.status == 2 ? 2 : 1);
  }
  const double lived = std::chrono::duration<double>(Clock::now() - child.started).count();
  if (lived >= settings_.settled_s) child.wait_s = settings_.first_wait_s;
  print_(fmt::format("insula: {} {}, starting it again in {:.1f} s", child.spec.name, exit.text(), child.wait_s));
  child.due = Clock::now() + seconds(child.wait_s);
  child.wait_s = std::min(2 * child.wait_s, settings_.longest_wait_s);
}

void Supervisor::end_all(int status) {
  if (ending_) return;
  ending_ = true;
  status_ = status;
  kill_at_ = Clock::now() + seconds(settings_.patience_s);
  for (auto& child : children_) {
    child->due.reset();
    child->process.send(SIGTERM);
    child->next.reset();
  }
}

int Supervisor::wait_ms() const {
  std::optional<Clock::time_point> next;
  const auto consider = [&](Clock::time_point t) { next = next ? std::min(*next, t) : t; };
  for (const auto& child : children_)
    if (child->due) consider(*child->due);
  if (ending_) consider(kill_at_);
  if (!ending_ && settings_.duration_s > 0) consider(began_ + seconds(settings_.duration_s));
  if (!ending_ && settings_.look) consider(Clock::now() + seconds(settings_.look_s));
  for (const auto& child : children_)
    if (child->next) consider(Clock::now() + std::chrono::milliseconds(50));
  if (!next) return 1000;  // a limit for safety; signals end the wait
  const auto ms = std::chrono::ceil<std::chrono::milliseconds>(*next - Clock::now()).count();
  return int(std::clamp<std::int64_t>(ms, 0, 1000));
}

void Supervisor::wait(int signal_descriptor) {
  std::vector<pollfd> waits{{signal_descriptor, POLLIN, 0}};
  for (const auto& child : children_)
    for (const ChildProcess* p : {&child->process, child->next ? &child->next->process : nullptr})
      if (p && p->output() >= 0) waits.push_back({p->output(), POLLIN, 0});
  ::poll(waits.data(), waits.size(), wait_ms());
}

int Supervisor::run() {
  const SignalPipe signals{SIGINT, SIGTERM, SIGHUP, SIGCHLD};
  ending_ = false;
  status_ = 0;
  began_ = Clock::now();
  for (auto& child : children_) start(*child);
  for (;;) {
    wait(signals.descriptor());
    while (const int signal = signals.next())
      if (signal != SIGCHLD) end_all(0);
    collect();
    if (!ending_ && settings_.look) settings_.look();
    const auto now = Clock::now();
    if (!ending_ && settings_.duration_s > 0 && now >= began_ + seconds(settings_.duration_s)) end_all(0);
    bool any_runs = false;
    for (auto& child : children_) {
      if (child->due && now >= *child->due) start(*child);
      any_runs |= child->process.running();
    }
    if (ending_ && !any_runs) break;
    if (ending_ && now >= kill_at_) {
      for (auto& child : children_) child->process.send(SIGKILL);
      kill_at_ = now + seconds(settings_.patience_s);
    }
  }
  print_("insula: ended");
  return status_;
}

std::string why_refused(const std::vector<std::string>& lines, const ChildExit& exit) {
  std::string text;
  for (const std::string& line : lines)
    if (line.find(": error: ") != std::string::npos || line.find(": warning: ") != std::string::npos ||
        line.starts_with("error: "))
      text += line + "\n";
  return text.empty() ? fmt::format("the engine that loaded it {}\n", exit.text()) : text;
}

}  // namespace insula
