// SPDX-License-Identifier: GPL-3.0-or-later
#include "viewer/gateway/studio_player.h"

#include <signal.h>

namespace insula::gateway {
namespace fs = std::filesystem;
namespace {

constexpr std::size_t longest_reload_error = 2000;
constexpr auto session_end = std::chrono::seconds(8);  // insula play ends its own children within three

}  // namespace

StudioPlayer::StudioPlayer(fs::path program, fs::path data) : program_(std::move(program)), data_(std::move(data)) {}

void StudioPlayer::play(const std::string& project, const fs::path& scene) { change(project, scene, false); }

void StudioPlayer::look_at(const std::string& project, const fs::path& scene) { change(project, scene, true); }

void StudioPlayer::end(const std::string& project) {
  if (project != project_) return;
  project_.clear(), next_.clear();
  child_.send(SIGTERM);
}

void StudioPlayer::change(const std::string& project, const fs::path& scene, bool view) {
  project_ = project, next_ = scene, view_ = view;
  url_.clear(), error_.clear(), last_line_.clear(), reload_error_.clear();
  tells_of_reload_ = false;
  kill_at_ = std::chrono::steady_clock::now() + session_end;
  child_.send(SIGTERM);
  look();
}

void StudioPlayer::start() {
  std::vector<std::string> command{
      program_.string(), view_ ? "view" : "play", next_.string(), "--no-browser", "--port", "8090"};
  if (!view_) command.insert(command.end(), {"--data", data_.string()});
  error_ = child_.start(command);
  next_.clear();
}

void StudioPlayer::hear(std::string_view line) {
  constexpr std::string_view serving = "viewer at ";
  if (!next_.empty()) return;  // what the session before says at its end
  const bool own = line.starts_with("insula: ");
  if (own) tells_of_reload_ = line.find("the saved scene has errors") != std::string_view::npos;
  if (own && line.find("the scene was saved") != std::string_view::npos) reload_error_.clear();
  if (!own && tells_of_reload_ && reload_error_.size() < longest_reload_error) reload_error_.append(line) += '\n';
  if (const std::size_t at = line.find(serving); at != std::string_view::npos) url_ = line.substr(at + serving.size());
  else last_line_ = line;
}

void StudioPlayer::look() {
  const auto heard = [this](std::string_view line) { hear(line); };
  child_.read_lines(heard);
  if (const auto exit = child_.reap()) {
    child_.finish_output(heard);
    if (next_.empty() && url_.empty()) error_ = last_line_.empty() ? "the session " + exit->text() : last_line_;
    url_.clear();
  }
  if (next_.empty()) return;
  if (!child_.running()) start();
  else if (std::chrono::steady_clock::now() > kill_at_) child_.send(SIGKILL);
}

nlohmann::json StudioPlayer::state(const std::string& project) const {
  if (project.empty() || project != project_) return nullptr;
  const bool runs = child_.running() || !next_.empty();
  return {{"state", !runs          ? "ended"
                    : url_.empty() ? "starting"
                                   : "running"},
          {"url", url_},
          {"error", error_.empty() ? reload_error_ : error_}};
}

}  // namespace insula::gateway
