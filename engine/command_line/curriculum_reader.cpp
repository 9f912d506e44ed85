// SPDX-License-Identifier: GPL-3.0-or-later
#include "engine/command_line/curriculum_reader.h"

#include <nlohmann/json.hpp>
#include <utility>

#include "engine/live/notice.h"

namespace insula {
namespace fs = std::filesystem;

CurriculumReader::CurriculumReader(const fs::path& program, const PlayOptions& options, fs::path file,
                                   ChildProcess::Line print)
    : command_{program.string()}, file_(std::move(file)), print_(std::move(print)) {
  for (const fs::path& path : options.plugin_paths) command_.insert(command_.end(), {"--plugin-path", path.string()});
  command_.insert(command_.end(), {"people", "curricula", "--output", file_.string()});
  if (!options.data.empty()) command_.insert(command_.end(), {"--data", options.data.string()});
}

void CurriculumReader::begin() {
  if (file_.empty() || std::exchange(begun_, true)) return;
  if (const std::string error = child_.start(command_); !error.empty()) failed(error);
}

void CurriculumReader::look() {
  if (!child_.running()) return;
  child_.read_lines(print_);
  const auto exit = child_.reap();
  if (!exit) return;
  child_.finish_output(print_);
  if (exit->status != 0) failed("reading the curricula " + exit->text());
}

void CurriculumReader::failed(const std::string& why) const {
  print_("insula: " + why);
  leave_notice(file_, nlohmann::json{{"problem", why}}.dump());
}

}  // namespace insula
