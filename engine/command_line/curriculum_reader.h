// SPDX-License-Identifier: GPL-3.0-or-later
// Reads the curricula for the start page beside a session, in a process of its own: it loads all of their scenes, which
// takes seconds.
#pragma once
#include <filesystem>
#include <functional>
#include <string>
#include <string_view>
#include <vector>

#include "core/base/child_process.h"
#include "engine/command_line/play.h"

namespace insula {

class CurriculumReader {
 public:
  /// file: gets curriculum_list_json(), or {"problem": text}; empty: nothing is read. print: gets a line of output.
  CurriculumReader(const std::filesystem::path& program, const PlayOptions& options, std::filesystem::path file,
                   ChildProcess::Line print);
  /// Reads them, unless that has been begun.
  void begin();
  /// Must be called repeatedly.
  void look();

 private:
  void failed(const std::string& why) const;

  std::vector<std::string> command_;
  std::filesystem::path file_;
  ChildProcess::Line print_;
  ChildProcess child_;
  bool begun_ = false;
};

}  // namespace insula
