// SPDX-License-Identifier: GPL-3.0-or-later
// What the page of the case builder asks for. All work is done by `insula_case` and `insula` as programs of their own,
// so that none of it can harm this one. Used on the network thread.
#pragma once
#include <cstdint>
#include <filesystem>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <string_view>

#include "viewer/gateway/api_answer.h"
#include "viewer/gateway/studio_job.h"
#include "viewer/gateway/studio_player.h"
#include "viewer/gateway/studio_poses.h"
#include "viewer/gateway/studio_projects.h"
#include "viewer/gateway/studio_scenes.h"

namespace insula::gateway {

struct StudioPlaces {
  std::filesystem::path data;      ///< folder of the user's data; empty: the page is not offered
  std::filesystem::path programs;  ///< folder of insula and insula_case
};

class Studio {
 public:
  /// What the case builder reads at most of a surface.
  static constexpr std::uint64_t most_upload_bytes = 220'000'000;

  explicit Studio(const StudioPlaces& places);
  /// Where the next file that comes is to be written.
  std::filesystem::path incoming();
  bool offered() const { return !places_.data.empty(); }

  /// path: what follows /api/studio/.
  ///   projects        {projects: [{name, file, state}], building, most_bytes}
  ///   project?name=   {name, file, choices, revision, undo, redo, command, scan: null or {state, error, facts},
  ///                    inspect: {state, error, number, facts},
  ///                    build: {state, error, seconds, stage, percent, step}, built: {current, report, exercises},
  ///                    trial: {state, error, found, current}, play: {state, url, error}}
  ///   pose?name=&pose=&parted=   StudioPoses::ask() of the built case; pose: six numbers, parted: 1 with the lobes
  ///   parted
  ApiAnswer get(std::string_view path, std::string_view query);
  ///   choose {name, revision, choices}; undo, redo, build, try {name, revision}; cancel, remove, again {name};
  ///   play {name, exercise}: the project, as above. revision: that of the choices that the page shows. If they have
  ///   changed since, the answer is 412 and nothing is done; 428: it is missing. again: the file is read once more.
  ///   edit {name}: a copy of the built scenes. What begins with "scene" is answered by StudioScenes. discard {upload}:
  ///   a cancelled upload becomes no project, whether all of it has arrived or will arrive.
  ApiAnswer post(std::string_view path, const std::string& body);
  /// file=: name of the author's file; upload=: what the page calls this upload, for discard. The new project. The
  /// content is moved to it.
  ApiAnswer upload(std::string_view query, const std::filesystem::path& content);
  /// surface, scan, side, front, fissure and report of the project name=; pose_surface of it with part=.
  std::optional<std::filesystem::path> file(std::string_view path, std::string_view query) const;
  /// Looks after the programs at work; about ten times a second.
  void look();

 private:
  ApiAnswer act(std::string_view path, StudioProject& project, const nlohmann::json& body);
  ApiAnswer change(StudioProject& project, std::string_view path, const nlohmann::json& body);
  ApiAnswer build(StudioProject& project);
  ApiAnswer play(StudioProject& project, const std::string& exercise);
  ApiAnswer shown(const StudioProject& project) const;
  nlohmann::json built_json(const StudioProject& project) const;
  const StudioJob* job(const std::string& name, StudioJob::Kind kind) const;
  std::string building() const;
  void inspect(StudioProject& project);
  void read_surface(StudioProject& project);
  void read_scan(StudioProject& project);
  void scan_ended(StudioProject& project, const StudioJob& job);
  void ended(const std::string& name, const StudioJob& job);
  void added(const std::string& name, const StudioJob& job);
  ApiAnswer pose(const StudioProject& project, std::string_view query);
  ApiAnswer discard(const std::string& upload);
  ApiAnswer try_clip(StudioProject& project);
  void trial_ended(StudioProject& project, const StudioJob& job);
  /// What was found, and whether it is that of the present choices.
  void add_trial(const StudioProject& project, nlohmann::json& trial) const;
  std::filesystem::path case_folder(const StudioProject& project) const;

  static constexpr const char* at_work = "the case is at work; wait, or cancel it";

  StudioPlaces places_;
  StudioProjects projects_;
  std::map<std::string, std::unique_ptr<StudioJob>> jobs_;          ///< by project: one each
  std::map<std::string, std::string> wanted_exercise_, add_error_;  ///< by project
  std::map<std::string, std::string> uploads_;  ///< their projects; empty: it is to be discarded when it comes
  StudioPlayer player_;
  StudioPoses poses_;
  StudioScenes scenes_;
  std::uint64_t came_ = 0;  ///< files so far
};

}  // namespace insula::gateway
