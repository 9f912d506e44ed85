// SPDX-License-Identifier: GPL-3.0-or-later
#include "engine/scene_reload.h"

#include <fmt/format.h>

#include <algorithm>

#include "engine/notice.h"
#include "engine/run.h"
#include "engine/scene_files.h"

namespace insula {
namespace {

// Editors that write a file in two goes are done by then; an author does not wait for it.
constexpr std::chrono::milliseconds quiet{300}, every{100};

}  // namespace

SceneReload::SceneReload(std::filesystem::path scene, std::vector<std::string> command, std::filesystem::path notice, Print print)
    : scene_(std::move(scene)), notice_(std::move(notice)), command_(std::move(command)), print_(std::move(print)), watch_(quiet) {
  watch_.set(scene_files(scene_));
}

void SceneReload::look(Supervisor& supervisor) {
  const auto now = FileWatch::Clock::now();
  if (now < next_) return;
  next_ = now + every;
  if (!watch_.saved(now)) return;
  watch_.set(scene_files(scene_));  // what it names may have changed
  print_("insula: the scene was saved; loading it");
  Supervisor::Offer offer;
  offer.command = command_;
  offer.ready_line = standby_line;
  offer.refused = [this](const auto& lines, const ChildExit& exit) { refused(lines, exit); };
  offer.taken = [this] { tell_viewers(""); };
  supervisor.offer("engine", std::move(offer));
}

void SceneReload::refused(const std::vector<std::string>& lines, const ChildExit& exit) {
  std::string text;
  for (const std::string& line : lines)
    if (line.find(": error: ") != std::string::npos || line.find(": warning: ") != std::string::npos || line.starts_with("error: ")) text += line + "\n";
  if (text.empty()) text = fmt::format("the saved scene cannot be run: the engine that loaded it {}\n", exit.text());
  print_("insula: the saved scene has errors; the one before goes on");
  std::string_view rest = text;
  while (!rest.empty()) {
    const std::size_t end = rest.find('\n');
    print_(rest.substr(0, end));
    rest.remove_prefix(end + 1);
  }
  tell_viewers(text);
}

void SceneReload::tell_viewers(const std::string& text) {
  if (!notice_.empty() && !leave_notice(notice_, text)) print_("insula: viewers cannot be told: " + notice_.string() + " cannot be written");
}

}  // namespace insula
