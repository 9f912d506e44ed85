// SPDX-License-Identifier: GPL-3.0-or-later
#include "engine/live/scene_reload.h"

#include <algorithm>

#include "core/registry/plugin_loader.h"
#include "engine/command_line/run.h"
#include "engine/live/notice.h"
#include "engine/live/scene_files.h"

namespace insula {
namespace {

// Long enough for editors that write a file twice, and short enough for an author.
constexpr std::chrono::milliseconds quiet{300}, every{100};

}  // namespace

SceneReload::SceneReload(std::filesystem::path scene, std::vector<std::filesystem::path> plugins,
                         std::vector<std::string> command, std::filesystem::path notice, Print print)
    : scene_(std::move(scene)),
      notice_(std::move(notice)),
      plugins_(std::move(plugins)),
      command_(std::move(command)),
      print_(std::move(print)),
      watch_(quiet) {
  watch_.set(files());
}

void SceneReload::watch(std::filesystem::path scene, std::vector<std::string> command) {
  scene_ = std::move(scene);
  command_ = std::move(command);
  waiting_ = false;
  watch_.set(files());
}

std::vector<std::filesystem::path> SceneReload::files() const {
  std::vector<std::filesystem::path> out = scene_files(scene_);
  std::error_code ec;
  for (const auto& path : plugins_) {
    const auto libraries = std::filesystem::is_directory(path, ec) ? plugin_files(path) : std::vector{path};
    out.insert(out.end(), libraries.begin(), libraries.end());
  }
  return out;
}

void SceneReload::look(Supervisor& supervisor) {
  const auto now = FileWatch::Clock::now();
  if (now < next_) return;
  next_ = now + every;
  if (watch_.saved(now)) {
    waiting_ = true;
    watch_.set(files());  // the scene may name other files now
    print_("insula: the scene was saved; loading it");
  }
  if (!waiting_) return;
  Supervisor::Offer offer;
  offer.command = command_;
  offer.ready_line = standby_line;
  offer.refused = [this](const auto& lines, const ChildExit& exit) { refused(why_refused(lines, exit)); };
  offer.taken = [this] { tell_viewers(""); };
  waiting_ = !supervisor.offer("engine", std::move(offer));
}

void SceneReload::refused(const std::string& why) {
  print_("insula: the saved scene has errors; the one before goes on");
  std::string_view rest = why;
  while (!rest.empty()) {
    const std::size_t end = rest.find('\n');
    print_(rest.substr(0, end));
    rest.remove_prefix(end + 1);
  }
  tell_viewers(why);
}

void SceneReload::tell_viewers(const std::string& text) {
  if (!notice_.empty() && !leave_notice(notice_, text))
    print_("insula: viewers cannot be told: " + notice_.string() + " cannot be written");
}

}  // namespace insula
