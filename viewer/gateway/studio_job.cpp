// SPDX-License-Identifier: GPL-3.0-or-later
#include "viewer/gateway/studio_job.h"

#include <signal.h>

#include <charconv>

#include "core/base/text.h"

namespace insula::gateway {
namespace {

constexpr auto time_to_end = std::chrono::seconds(3);  // from SIGTERM to SIGKILL
constexpr std::size_t longest_error = 4000;
constexpr std::string_view error_begins = "error: ";

}  // namespace

StudioJob::StudioJob(Kind kind, const std::vector<std::string>& command, std::chrono::seconds limit)
    : kind_(kind), limit_(began_ + limit) {
  error_ = child_.start(command);
  ended_ = !error_.empty();
}

/// "wall      40 %  checks", as the case builder tells how far it is (tools/case_builder/progress.h); or an error,
/// which may have several lines.
void StudioJob::hear(std::string_view line) {
  if (line.starts_with(error_begins)) {
    tells_error_ = true;
    said_ = line.substr(error_begins.size());
    return;
  }
  if (tells_error_) {
    if (said_.size() < longest_error && !trim(line).empty()) said_ += "\n" + std::string(line);
    return;
  }
  const std::size_t sign = line.find(" %  ");
  const std::vector<std::string_view> words = split_blanks(line.substr(0, std::min(sign, line.size())));
  int percent = 0;
  if (sign == std::string_view::npos || words.size() != 2 ||
      std::from_chars(words[1].data(), words[1].data() + words[1].size(), percent).ec != std::errc())
    return;
  stage_ = words[0], percent_ = percent, step_ = line.substr(sign + 4);
}

void StudioJob::cancel() {
  if (ended_ || cancelled_) return;
  cancelled_ = true;
  child_.send(SIGTERM);
  kill_at_ = Clock::now() + time_to_end;
}

void StudioJob::end(const ChildExit& exit) {
  ended_ = true;
  if (exit.signal == 0 && exit.status == 0) return;
  if (late_) error_ = "this takes too long: give a surface with fewer triangles, or only the part around the aneurysm";
  else if (cancelled_) error_ = "cancelled";
  else if (tells_error_) error_ = said_;
  else
    error_ = "the case builder " + exit.text() + (stage_.empty() ? "" : " in the stage " + stage_) +
             "; nothing of your project is lost, so try again";
}

bool StudioJob::look() {
  if (ended_) return true;
  const auto heard = [this](std::string_view line) { hear(line); };
  child_.read_lines(heard);
  if (const auto exit = child_.reap()) {
    child_.finish_output(heard);
    end(*exit);
    return true;
  }
  const auto now = Clock::now();
  if (now > limit_ && !cancelled_) {
    late_ = true;
    cancel();
  }
  if (now > kill_at_) child_.send(SIGKILL);
  return false;
}

}  // namespace insula::gateway
