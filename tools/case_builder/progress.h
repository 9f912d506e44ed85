// SPDX-License-Identifier: GPL-3.0-or-later
// Tells on the terminal what is being done and how far it is; on a log, one line a step.
#pragma once
#include <cstdio>
#include <string>

namespace insula::case_builder {

class Progress {
 public:
  /// `out` null: says nothing.
  explicit Progress(std::FILE* out = nullptr);
  ~Progress() { end_line(); }
  /// A stage begins, with so many steps.
  void stage(const std::string& name, int steps);
  /// Its next step begins.
  void step(const std::string& what);
  /// How much of that step is done, 0..1.
  void share(double done);
  void finish();

 private:
  void draw(double done);
  void end_line();
  std::FILE* out_;
  bool terminal_ = false, open_ = false;
  std::string stage_, what_;
  int steps_ = 1, at_ = 0, last_ = -1;
};

}  // namespace insula::case_builder
