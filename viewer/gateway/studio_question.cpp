// SPDX-License-Identifier: GPL-3.0-or-later
#include "viewer/gateway/studio_question.h"

#include <signal.h>

namespace insula::gateway {
namespace {

constexpr std::size_t longest_answer = 8'000'000;
constexpr std::size_t longest_reason = 2000;

}  // namespace

StudioQuestion::StudioQuestion(const std::vector<std::string>& command, std::chrono::seconds limit)
    : limit_(Clock::now() + limit) {
  error_ = child_.start(command);
  ended_ = !error_.empty();
  end_ = Clock::now();
}

bool StudioQuestion::look() {
  if (ended_) return true;
  const auto heard = [this](std::string_view line) {
    if (said_.size() < longest_answer) said_.append(line) += '\n';
  };
  child_.read_lines(heard);
  if (!late_ && Clock::now() > limit_) {
    late_ = true;
    child_.send(SIGKILL);
  }
  const auto exit = child_.reap();
  if (!exit) return false;
  child_.finish_output(heard);
  ended_ = true;
  end_ = Clock::now();
  if (late_) error_ = "this takes too long";
  else if (exit->signal != 0 || exit->status != 0)
    error_ = said_.empty() ? "the program " + exit->text() : said_.substr(0, longest_reason);
  return true;
}

nlohmann::json StudioQuestion::answer() const { return nlohmann::json::parse(said_, nullptr, false); }

}  // namespace insula::gateway
