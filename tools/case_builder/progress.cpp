// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/case_builder/progress.h"

#include <unistd.h>

#include <algorithm>

namespace insula::case_builder {

Progress::Progress(std::FILE* out) : out_(out), terminal_(out && isatty(fileno(out))) {}

void Progress::stage(const std::string& name, int steps) {
  end_line();
  stage_ = name, steps_ = std::max(1, steps), at_ = 0, what_.clear();
}

void Progress::step(const std::string& what) {
  what_ = what, ++at_, last_ = -1;
  draw(0);
}

void Progress::share(double done) {
  if (terminal_) draw(std::clamp(done, 0.0, 1.0));
}

void Progress::finish() {
  what_ = "done", at_ = steps_, last_ = -1;
  draw(1);
  end_line();
}

void Progress::draw(double done) {
  if (!out_) return;
  const double all = std::clamp((at_ - 1 + done) / steps_, 0.0, 1.0);
  const int percent = int(100 * all + 0.5);
  if (terminal_) {
    if (percent == last_) return;
    constexpr int width = 24;
    const std::string bar(std::size_t(width * all), '#');
    std::fprintf(out_, "\r\033[K%-7s [%-*s] %3d %%  %s", stage_.c_str(), width, bar.c_str(), percent, what_.c_str());
    open_ = true;
  } else {
    std::fprintf(out_, "%-7s %3d %%  %s\n", stage_.c_str(), percent, what_.c_str());
  }
  last_ = percent;
  std::fflush(out_);
}

void Progress::end_line() {
  if (open_) std::fputc('\n', out_);
  open_ = false;
}

}  // namespace insula::case_builder
